// SPDX-License-Identifier: Apache-2.0
// The official schema is checked by tests/contract/validate_cli_test.py; these are properties that the schema cannot express.
#include <string>

#include "catch.hpp"
#include "sample_report.hpp"

using namespace fdcg::bake;
using fdcg::test::sample_report;
using fdcg::test::unreadable_report;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
    ++n;
  return n;
}

}  // namespace

TEST_CASE("JUnit: a suite per file, a case per rule that ran, failures only for what fails the verdict") {
  const std::string xml = report_string(ReportFormat::junit, {sample_report(), unreadable_report()});
  CAPTURE(xml);
  CHECK(count(xml, "<testsuite ") == 2);
  CHECK(count(xml, "<testcase ") == 4 + 2);
  CHECK(count(xml, "<failure ") == 1);
  CHECK(xml.find("tests=\"4\" failures=\"1\" errors=\"0\" time=\"0.250\"") != std::string::npos);
  CHECK(
      xml.find("<failure type=\"non-manifold-edge\" message=\"300 edges have &lt;more&gt; than two faces. Split [them].\">") !=
      std::string::npos);
  CHECK(xml.find("line 10, vertex 0, edge 0-7, faces 0 1, part &quot;wheel ") != std::string::npos);
  CHECK(xml.find("and 200 more") != std::string::npos);
  CHECK(xml.find("<system-out>warning boundary-edge, allowed: 1 edge") != std::string::npos);
  CHECK(xml.find("note isolated-vertex, known: 7 vertices") != std::string::npos);
  // A file that could not be read is an error, not a failure.
  CHECK(xml.find("tests=\"2\" failures=\"0\" errors=\"1\"") != std::string::npos);
  CHECK(count(xml, "<error type=\"unreadable\"") == 1);
}

TEST_CASE("JUnit: the level from which findings fail decides") {
  Report report = sample_report();
  report.fail_on = Severity::note;
  report.issues[2].known = 6;
  CHECK(count(report_string(ReportFormat::junit, {report}), "<failure ") == 2);
  report.fail_on = std::nullopt;
  CHECK(count(report_string(ReportFormat::junit, {report}), "<failure ") == 0);
}

TEST_CASE("JUnit: names are escaped") {
  Report report = sample_report();
  for (int byte = 1; byte < 256; ++byte)
    report.file += static_cast<char>(byte);
  report.file += "\xEF\xBF\xBE\xED\xA0\x80]]>";  // U+FFFE, a surrogate
  const std::string xml = report_string(ReportFormat::junit, {report});
  CHECK(count(xml, "<testsuite ") == 1);
  CHECK(count(xml, "]]>") == 0);
  for (const char c : xml) {
    const auto byte = static_cast<unsigned char>(c);
    CHECK((byte >= 0x20 || byte == '\n'));
  }
  CHECK(xml.find("\xEF\xBF\xBE") == std::string::npos);
  CHECK(xml.find("&#10;") != std::string::npos);
}
