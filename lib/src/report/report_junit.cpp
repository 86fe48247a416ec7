// SPDX-License-Identifier: Apache-2.0
// JUnit XML in the format of Ant's JUnit task (schema of Windy Road): one test suite per file, one test case per rule that ran.
#include <algorithm>
#include <charconv>
#include <utility>

#include "report/report_parts.hpp"
#include "shared/text.hpp"

namespace fdcg::bake {
namespace {

// XML 1.0 cannot represent most control characters, U+FFFE and U+FFFF: they are replaced, as are bytes that are not UTF-8.
std::string escaped(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint point = code_point_at(text, at);
    const bool is_xml = point.value >= 0x20 ? point.value != 0xFFFE && point.value != 0xFFFF
                                            : point.value == '\t' || point.value == '\n' || point.value == '\r';
    if (point.bytes == 0 || !is_xml) {
      out += kReplacement;
    } else if (point.value < 0x20) {
      out += "&#" + std::to_string(static_cast<unsigned>(point.value)) + ";";  // in an attribute, unescaped, it becomes a blank
    } else if (point.value == '&') {
      out += "&amp;";
    } else if (point.value == '<') {
      out += "&lt;";
    } else if (point.value == '>') {
      out += "&gt;";
    } else if (point.value == '"') {
      out += "&quot;";
    } else {
      out += text.substr(at, point.bytes);
    }
    at += std::max<std::size_t>(point.bytes, 1);
  }
  return out;
}

// A name that stays non-empty as xs:token of the schema, which strips blanks at both ends.
std::string name_of_suite(const std::string& file) {
  const bool is_blank = file.find_first_not_of(" \t\r\n") == std::string::npos;
  return escaped(is_blank ? "\"" + file + "\"" : file);
}

std::string text_of(const Issue& issue, std::size_t max_elements) {
  std::string out = issue.message + "\n";
  const std::size_t shown = std::min(issue.elements.size(), max_elements);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string where = place_of(issue.elements[i]);
    if (!where.empty()) out += where + (issue.elements[i].is_known ? " (known)" : "") + "\n";
  }
  if (issue.total > shown && shown != 0) out += "and " + std::to_string(issue.total - shown) + " more\n";
  return out;
}

// The rules that ran, and any other with findings.
std::vector<std::string> rules_of(const Report& report) {
  std::vector<std::string> names = report.checks;
  for (const Issue& issue : report.issues) {
    if (std::find(names.begin(), names.end(), issue.rule) == names.end()) names.push_back(issue.rule);
  }
  return names;
}

std::string seconds_text(double seconds) {
  char buffer[64];
  return {buffer, std::to_chars(std::begin(buffer), std::end(buffer), seconds, std::chars_format::fixed, 3).ptr};
}

std::string property(std::string_view name, std::string_view value) {
  return "<property name=\"" + escaped(name) + "\" value=\"" + escaped(value) + "\"/>\n";
}

class JunitWriter final : public ReportWriter {
 public:
  JunitWriter(Write write, const ReportOptions& options) : write_(std::move(write)), options_(options) {
    write_("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
  }

  void add(const Report& report) override {
    const std::string file = name_of_suite(report.file);
    std::string cases, others;
    std::size_t failures = 0, errors = 0;
    const std::vector<std::string> rules = rules_of(report);
    for (const std::string& rule : rules) {
      cases += "<testcase name=\"" + escaped(rule) + "\" classname=\"" + file + "\" time=\"0\"";
      const auto issue =
          std::find_if(report.issues.begin(), report.issues.end(), [&](const Issue& i) { return i.rule == rule; });
      if (issue == report.issues.end() || !fails(report, *issue)) {
        cases += "/>\n";
        if (issue != report.issues.end()) others += note_of(report, *issue);
        continue;
      }
      const bool is_error = is_import_failure(report);  // the file could not be tested at all
      ++(is_error ? errors : failures);
      const std::string element = is_error ? "error" : "failure";
      cases += ">\n<" + element + " type=\"" + escaped(rule) + "\" message=\"" + escaped(issue->message) + "\">" +
               escaped(text_of(*issue, options_.max_elements)) + "</" + element + ">\n</testcase>\n";
    }
    write_("<testsuite name=\"" + file + "\" package=\"fdcg\" id=\"" + std::to_string(suites_++) + "\" timestamp=\"" +
           escaped(options_.timestamp) + "\" hostname=\"localhost\" tests=\"" + std::to_string(rules.size()) +
           "\" failures=\"" + std::to_string(failures) + "\" errors=\"" + std::to_string(errors) + "\" time=\"" +
           seconds_text(report.seconds) + "\">\n" + properties_of(report) + cases + "<system-out>" + escaped(others) +
           "</system-out>\n<system-err></system-err>\n</testsuite>\n");
  }
  void finish(int /*exit_code*/) override { write_("</testsuites>\n"); }

 private:
  static std::string properties_of(const Report& report) {
    std::string out = "<properties>\n" + property("vertices", std::to_string(report.vertices)) +
                      property("faces", std::to_string(report.faces)) +
                      property("kept_faces", std::to_string(report.kept_faces)) +
                      property("components", std::to_string(report.components));
    for (const Ignored& ignored : report.ignored)
      out += property("ignored " + ignored.what, std::to_string(ignored.count));
    for (const auto& [rule, total] : report.resolved)
      out += property("resolved " + rule, std::to_string(total));
    if (!report.config.empty()) out += property("config", report.config);
    return out + "</properties>\n";
  }
  // Findings that do not fail: below the severity, allowed or known.
  std::string note_of(const Report& report, const Issue& issue) const {
    const std::string excuse = report.allowed.count(issue.rule) != 0            ? ", allowed"
                               : issue.known == issue.total && issue.known != 0 ? ", known"
                                                                                : "";
    return std::string(name_of(issue.severity)) + " " + issue.rule + excuse + ": " + text_of(issue, options_.max_elements);
  }

  Write write_;
  ReportOptions options_;
  std::size_t suites_ = 0;
};

}  // namespace

std::unique_ptr<ReportWriter> make_junit_writer(Write write, const ReportOptions& options) {
  return std::make_unique<JunitWriter>(std::move(write), options);
}

}  // namespace fdcg::bake
