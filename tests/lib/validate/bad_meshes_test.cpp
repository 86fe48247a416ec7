// SPDX-License-Identifier: Apache-2.0
// The meshes of testdata/meshes/bad: each is named after the rule that it raises, and each rule has one.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "catch.hpp"
#include "fdcg/bake.hpp"

using namespace fdcg::bake;

namespace {

// The rule with the longest name that the file's name starts with.
const Rule* rule_of(const std::string& file) {
  const Rule* found = nullptr;
  for (const Rule& rule : rules()) {
    if (file.starts_with(rule.name) && (found == nullptr || rule.name.size() > found->name.size())) found = &rule;
  }
  return found;
}

Report report_of(const char* file) {
  const auto soup = import_mesh(std::filesystem::path(FDCG_SOURCE_DIR) / "testdata/meshes/bad" / file);
  REQUIRE(soup.has_value());
  return validate(*soup);
}
std::string message_of(const char* file, const char* rule) {
  for (const Issue& issue : report_of(file).issues)
    if (issue.rule == rule) return issue.message;
  return {};
}

}  // namespace

TEST_CASE("every bad mesh raises the rule in its name, and every rule has a mesh") {
  std::set<std::string_view> raised;
  const std::set<std::string> run = [] {
    const std::vector<std::string> checks = validate(PolygonSoup{}).checks;
    return std::set<std::string>(checks.begin(), checks.end());
  }();
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(FDCG_SOURCE_DIR) / "testdata/meshes/bad")) {
    const std::string name = entry.path().filename().string();
    INFO(name);
    const Rule* const rule = rule_of(name);
    REQUIRE(rule != nullptr);
    raised.insert(rule->name);
    const auto soup = import_mesh(entry.path());
    if (!soup) {
      CHECK(soup.error().rule == rule->name);
      continue;
    }
    if (run.count(std::string(rule->name)) == 0) continue;
    const Report report = validate(*soup);
    const auto issue =
        std::find_if(report.issues.begin(), report.issues.end(), [&](const Issue& i) { return i.rule == rule->name; });
    REQUIRE(issue != report.issues.end());
    CHECK(issue->severity == rule->severity);
    CHECK(issue->total >= 1);
    CHECK_FALSE(issue->elements.empty());
    CHECK(report.passes() == std::none_of(report.issues.begin(), report.issues.end(),
                                          [](const Issue& i) { return i.severity == Severity::error; }));
  }
  for (const Rule& rule : rules()) {
    INFO(rule.name);
    CHECK(raised.count(rule.name) == 1);
  }
}

TEST_CASE("a degenerate face is reported with its kind of degeneracy") {
  CHECK(
      message_of("degenerate-face-on-a-line.off", "degenerate-face").starts_with("1 face has all corners on one line. Delete"));
  CHECK(message_of("degenerate-face-repeated-corner.off", "degenerate-face")
            .starts_with("1 face names fewer than three vertices. Delete"));
  CHECK(message_of("degenerate-face-bridged-hole.off", "degenerate-face")
            .starts_with("1 face names a corner twice, as around a bridge to a hole. Triangulate"));
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  soup.corners = {0, 1, 1, 0, 1, 2, 0, 2, 1, 0, 1, 3, 0, 4};
  soup.face_first = {0, 3, 6, 9, 14};
  const Report report = validate(soup);
  CHECK(report.issues[0].message.starts_with(
      "4 faces are degenerate: 1 names fewer than three vertices, 1 names a corner twice, 2 have all corners on one line. "));
}

TEST_CASE("a T-junction names the vertex, the edge and its face") {
  const Report report = report_of("t-junction.off");
  const auto issue =
      std::find_if(report.issues.begin(), report.issues.end(), [](const Issue& i) { return i.rule == "t-junction"; });
  REQUIRE(issue != report.issues.end());
  REQUIRE(issue->total == 1);
  const Element& element = issue->elements[0];
  CHECK(element.vertices == std::vector<std::uint32_t>{4});
  CHECK(element.edges == std::vector<std::array<std::uint32_t, 2>>{{0, 1}});
  CHECK(element.faces == std::vector<std::uint32_t>{0});
  CHECK(element.point == Vec3{1, 0, 0});
  CHECK(element.line == 10U);  // of the edge's face
}
