// SPDX-License-Identifier: Apache-2.0
// The verdict of a report, and the choice of its format.
#include <algorithm>
#include <utility>

#include "fdcg/bake.hpp"
#include "report/report_parts.hpp"

namespace fdcg::bake {

bool Report::passes(std::optional<Severity> level) const {
  return !level || std::none_of(issues.begin(), issues.end(), [&](const Issue& issue) {
    return issue.total > issue.known && issue.severity >= *level && allowed.count(issue.rule) == 0;
  });
}

std::unique_ptr<ReportWriter> make_report_writer(ReportFormat format, Write write, const ReportOptions& options) {
  switch (format) {
    case ReportFormat::json:
      return make_json_writer(std::move(write), options);
    case ReportFormat::sarif:
      return make_sarif_writer(std::move(write), options);
    case ReportFormat::junit:
      return make_junit_writer(std::move(write), options);
    case ReportFormat::text:
      break;
  }
  return make_text_writer(std::move(write), options);
}

std::string report_string(ReportFormat format, const std::vector<Report>& reports, const ReportOptions& options) {
  constexpr int kFindings = 1, kFile = 3;
  std::string out;
  int exit_code = 0;
  const auto writer = make_report_writer(
      format, [&out](std::string_view piece) { out += piece; }, options);
  for (const Report& report : reports) {
    writer->add(report);
    if (!report.passes()) exit_code = std::max(exit_code, kFindings);
    if (is_import_failure(report)) exit_code = kFile;
  }
  writer->finish(exit_code);
  return out;
}

}  // namespace fdcg::bake
