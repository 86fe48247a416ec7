// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "catch.hpp"
#include "soups.hpp"
#include "validate/validate.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::make_soup;
using nlohmann::json;

namespace {

Report defective() {
  PolygonSoup soup = cube();
  soup.name = "dir/part \"7\".off";
  soup.corners[0] = PolygonSoup::kInvalidVertex;
  soup.points.push_back({std::numeric_limits<double>::quiet_NaN(), 1, std::numeric_limits<double>::infinity()});
  soup.face_line = {10, 11, 12, 13, 14, 15};
  return validate(soup);
}

}  // namespace

TEST_CASE("the catalogue names every rule once, with texts, and find_rule finds it") {
  std::set<std::string_view> names;
  for (const Rule& rule : rules()) {
    CHECK(names.insert(rule.name).second);
    CHECK(find_rule(rule.name) == &rule);
    CHECK_FALSE(rule.meaning.empty());
    CHECK_FALSE(rule.why.empty());
    CHECK_FALSE(rule.remedy.empty());
  }
  for (const char* name : {"self-intersection", "t-junction", "sliver-face", "unreadable"})
    CHECK(names.count(name) == 1);
  CHECK(names.size() == 20);
  CHECK(find_rule("no-such-rule") == nullptr);
  CHECK(find_rule("") == nullptr);
  for (const char* name : {"index-out-of-range", "non-manifold-edge", "not-orientable", "folded-edge", "self-crossing-face"}) {
    CHECK_FALSE(find_rule(name)->can_be_allowed);
  }
  CHECK(find_rule("inside-out")->can_be_allowed);
}

TEST_CASE("a report passes unless an issue reaches the level and is not allowed") {
  Report report;
  CHECK(report.passes(Severity::note));
  report.issues.push_back({"boundary-edge", Severity::warning, 3, "", {}});
  CHECK(report.passes());
  CHECK_FALSE(report.passes(Severity::warning));
  CHECK_FALSE(report.passes(Severity::note));
  report.issues.push_back({"inside-out", Severity::error, 1, "", {}});
  CHECK_FALSE(report.passes());
  report.allowed = {"inside-out"};
  CHECK(report.passes());
}

TEST_CASE("the JSON has the promised members, with null for what is not finite") {
  const json document = json::parse(report_json({defective(), validate(cube())}));
  CHECK(document["tool"] == "fdcg");
  REQUIRE(document["files"].size() == 2);
  const json& file = document["files"][0];
  CHECK(file["file"] == "dir/part \"7\".off");
  CHECK(file["verdict"] == "fail");
  CHECK(file["vertices"] == 9);
  CHECK(file["faces"] == 6);
  CHECK(file["components"] == 1);
  std::vector<std::string> order;
  for (const json& issue : file["issues"]) {
    order.push_back(issue["rule"]);
    CHECK(issue["total"].get<int>() > 0);
    CHECK(issue["message"].get<std::string>().rfind(std::to_string(issue["total"].get<int>()) + " ", 0) == 0);
    CHECK(issue["severity"].is_string());
    for (const json& element : issue["elements"]) {
      for (const char* key : {"faces", "edges", "vertices"})
        CHECK(element[key].is_array());
    }
  }
  CHECK(order == std::vector<std::string>{"non-finite-coordinate", "index-out-of-range", "boundary-edge", "isolated-vertex"});
  CHECK(file["issues"][0]["elements"][0]["point"] == json::array({nullptr, 1.0, nullptr}));
  CHECK(file["issues"][1]["elements"][0]["line"] == 10);
  CHECK(file["issues"][2]["severity"] == "warning");
  CHECK(document["files"][1]["verdict"] == "pass");
  CHECK(document["files"][1]["issues"].empty());
  CHECK(report_json({defective()}) == report_json({defective()}));
}

TEST_CASE("bytes of a path that are not UTF-8 do not break the JSON") {
  Report report;
  report.file = "a\xFF\xC3.off";
  CHECK(json::parse(report_json({report}))["files"][0]["file"].get<std::string>().rfind("a\xEF\xBF\xBD", 0) == 0);
}

TEST_CASE("the text gives verdict, totals, places and remedy, coloured only on request") {
  const std::string text = report_text(defective(), false);
  CAPTURE(text);
  CHECK(text.find("dir/part \"7\".off: fail (9 vertices, 6 faces, 5 of them kept, 1 component)\n") == 0);
  CHECK(text.find("error index-out-of-range: 1 face names a vertex that the file does not have.") != std::string::npos);
  CHECK(text.find("line 10, face 0, at ") != std::string::npos);
  CHECK(text.find("at (nan, 1, inf)") != std::string::npos);
  CHECK(text.find("and 1 more") != std::string::npos);
  CHECK(text.find('\033') == std::string::npos);
  CHECK(report_text(defective(), true).find("\033[31mfail\033[0m") != std::string::npos);
  CHECK(report_text(validate(cube()), false) == "made in code: pass (8 vertices, 6 faces, 1 component)\n");
}

TEST_CASE("a report stays under a megabyte however bad the mesh is") {
  PolygonSoup soup = bumpy_sphere(120, 120);
  const std::vector<std::uint32_t> corners = soup.corners;
  for (int copies = 0; copies < 3; ++copies) {  // every edge has many faces, every face has copies
    for (std::size_t f = 0; f < corners.size() / 3; ++f) {
      soup.corners.insert(soup.corners.end(), corners.begin() + 3 * f, corners.begin() + 3 * f + 3);
      soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    }
  }
  for (std::uint32_t i = 0; i < 500; ++i)
    soup.points[i * 7].x = std::numeric_limits<double>::quiet_NaN();
  const Report report = validate(soup);
  CHECK(report.issues[0].total == 500);
  CHECK(report.issues[0].elements.size() == 100);
  CHECK(report_json({report}).size() < 1000000);
}

TEST_CASE("no format passes a megabyte when every rule has as many and as large elements as can be listed") {
  Report report;
  report.file = std::string(200, 'x');
  for (const Rule& rule : rules()) {
    Issue issue{std::string(rule.name), rule.severity, 4000000000, std::string(rule.remedy), {}, 0};
    for (std::uint32_t i = 0; i < kListedElements; ++i) {
      Element element;
      element.faces.assign(rule.name == "non-manifold-edge" ? 32 : 2, 4000000000u - i);
      element.edges = {{4000000000u, 4000000001u}};
      element.vertices = {4000000002u};
      element.point = Vec3{-1.2345678901234567e-100, -1.2345678901234567e-101, -1.2345678901234567e-102};
      element.line = 4000000000u;
      element.part = std::string(5000, 'p');
      element.fingerprint = ~std::uint64_t{0} - i;
      issue.elements.push_back(element);
    }
    report.issues.push_back(issue);
    report.checks.push_back(issue.rule);
  }
  ReportOptions each;
  each.result_per_element = true;
  CHECK(report_text(report, false).size() < 1000000);
  CHECK(report_string(ReportFormat::json, {report}).size() < 1000000);
  CHECK(report_string(ReportFormat::junit, {report}).size() < 1000000);
  CHECK(report_string(ReportFormat::sarif, {report}).size() < 1000000);
  CHECK(report_string(ReportFormat::sarif, {report}, each).size() < 1000000);
}
