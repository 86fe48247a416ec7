// SPDX-License-Identifier: Apache-2.0
// The text report: one line per file, one line per rule with the remedy, the first few places.
#include <algorithm>
#include <utility>

#include "report/report_parts.hpp"
#include "shared/text.hpp"

namespace fdcg::bake {
namespace {

constexpr std::string_view kRed = "\033[31m", kYellow = "\033[33m", kGreen = "\033[32m", kBold = "\033[1m", kPlain = "\033[0m";

std::string painted(std::string_view text, std::string_view colour, bool on) {
  if (!on) return std::string(text);
  return std::string(colour) + std::string(text) + std::string(kPlain);
}

// In brackets after the rule's name: why not all of its findings count.
std::string excuse_of(const Report& report, const Issue& issue) {
  if (report.allowed.count(issue.rule) != 0) return " (allowed)";
  if (issue.known == 0) return "";
  return issue.known == issue.total ? " (known)" : " (" + std::to_string(issue.known) + " known)";
}

void append_issue(std::string& out, const Report& report, const Issue& issue, bool colour) {
  constexpr std::size_t kShown = 3;
  const std::string_view paint = issue.severity == Severity::error     ? kRed
                                 : issue.severity == Severity::warning ? kYellow
                                                                       : kBold;
  out += "  " + painted(name_of(issue.severity), paint, colour) + " " + painted(issue.rule, kBold, colour) +
         excuse_of(report, issue) + ": " + printable(issue.message) + "\n";
  const std::size_t shown = std::min(issue.elements.size(), kShown);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string where = place_of(issue.elements[i]);
    if (!where.empty()) out += "    " + where + (issue.elements[i].is_known ? " (known)" : "") + "\n";
  }
  if (shown > 0 && issue.total > shown) out += "    and " + std::to_string(issue.total - shown) + " more\n";
}

// "  ignored: 3 line elements, 2 free points"
template <class List, class Print>
void append_summary(std::string& out, std::string_view title, const List& list, Print print) {
  std::string text;
  for (const auto& item : list)
    text += (text.empty() ? "" : ", ") + print(item);
  if (!text.empty()) out += "  " + std::string(title) + ": " + text + "\n";
}

std::string counts_of(const Report& report) {
  if (is_import_failure(report)) return "no mesh";
  std::string out = counted(report.vertices, "vertex", "vertices") + ", " + counted(report.faces, "face", "faces");
  if (report.kept_faces < report.faces) out += ", " + std::to_string(report.kept_faces) + " of them kept";
  return out + ", " + counted(report.components, "component", "components");
}

class TextWriter final : public ReportWriter {
 public:
  TextWriter(Write write, bool colour) : write_(std::move(write)), colour_(colour) {}

  void add(const Report& report) override {
    write_(report_text(report, colour_));
    ++files_;
    if (!report.passes()) ++failed_;
  }
  void finish(int /*exit_code*/) override {
    if (files_ < 2) return;
    const bool passes = failed_ == 0;
    write_(counted(files_, "file", "files") + ": " + std::to_string(files_ - failed_) + " pass, " +
           painted(std::to_string(failed_) + " fail", passes ? kGreen : kRed, colour_) + "\n");
  }

 private:
  Write write_;
  bool colour_;
  std::uint64_t files_ = 0, failed_ = 0;
};

}  // namespace

std::string report_text(const Report& report, bool colour) {
  const bool passes = report.passes();
  std::string out = painted(printable(report.file), kBold, colour) + ": " +
                    painted(passes ? "pass" : "fail", passes ? kGreen : kRed, colour) + " (" + counts_of(report) + ")\n";
  for (const Issue& issue : report.issues)
    append_issue(out, report, issue, colour);
  append_summary(out, "left out", report.ignored,
                 [](const Ignored& ignored) { return std::to_string(ignored.count) + " " + printable(ignored.what); });
  append_summary(out, "resolved since the baseline", report.resolved,
                 [](const auto& rule) { return std::to_string(rule.second) + " " + rule.first; });
  if (!report.config.empty()) out += "  settings: " + printable(report.config) + "\n";
  return out;
}

std::unique_ptr<ReportWriter> make_text_writer(Write write, const ReportOptions& options) {
  return std::make_unique<TextWriter>(std::move(write), options.colour);
}

}  // namespace fdcg::bake
