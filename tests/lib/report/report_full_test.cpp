// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "sample_report.hpp"
#include "soups.hpp"

using namespace fdcg::bake;
using fdcg::test::sample_element;
using fdcg::test::sample_report;
using nlohmann::json;

namespace {

std::string full(Report& report, ElementSpool& spool) {
  std::string out;
  FullReportWriter writer([&out](std::string_view piece) { out += piece; });
  REQUIRE(writer.add(report, spool));
  writer.finish();
  return out;
}

}  // namespace

TEST_CASE("a full report is the JSON report with every element") {
  Report report = sample_report();
  report.issues[0].total = 100;
  ElementSpool spool;
  for (const Issue& issue : report.issues) {
    for (const Element& element : issue.elements)
      spool.add(issue.rule, element);
  }
  CHECK(full(report, spool) == report_json({report}));
}

TEST_CASE("elements buffered in a file come back complete and in order") {
  constexpr std::uint32_t kMany = 30000;  // some 6 MB: several times what a pile keeps
  Report report = sample_report();
  report.issues[0].total = kMany;
  ElementSpool spool;
  for (std::uint32_t i = 0; i < kMany; ++i) {
    spool.add("non-manifold-edge", sample_element(i));
    if (i < 2) spool.add("boundary-edge", sample_element(i));
  }
  const json document = json::parse(full(report, spool));
  const json& elements = document["files"][0]["issues"][0]["elements"];
  REQUIRE(elements.size() == kMany);
  bool is_in_order = true;
  for (std::uint32_t i = 0; i < kMany; ++i)
    is_in_order = is_in_order && elements[i]["line"] == i + 10;
  CHECK(is_in_order);
  CHECK(document["files"][0]["issues"][1]["elements"].size() == 2);
  CHECK(document["files"][0]["issues"][2]["elements"].empty());
}

TEST_CASE("every finding reaches the callback once, in source order, and known ones are replaced in the list") {
  PolygonSoup soup = fdcg::test::bumpy_sphere(40, 40);
  for (std::uint32_t i = 0; i < 500; ++i)
    soup.points.push_back({i + 10.0, 0, 0});  // 500 isolated vertices
  const std::uint32_t first = static_cast<std::uint32_t>(soup.points.size()) - 500;
  const auto isolated = [&](std::uint32_t known_below, std::size_t max_elements) {
    std::vector<std::uint32_t> seen;
    ValidateOptions options;
    options.max_elements = max_elements;
    options.each_element = [&](std::string_view rule, Element& element) {
      if (rule != "isolated-vertex") return;
      seen.push_back(element.vertices.at(0) - first);
      element.is_known = seen.back() < known_below;
    };
    const Report report = validate(soup, options);
    REQUIRE(seen.size() == 500);
    CHECK(std::is_sorted(seen.begin(), seen.end()));
    const auto issue =
        std::find_if(report.issues.begin(), report.issues.end(), [](const Issue& i) { return i.rule == "isolated-vertex"; });
    REQUIRE(issue != report.issues.end());
    CHECK(issue->total == 500);
    CHECK(issue->known == std::min(known_below, 500u));
    std::vector<std::uint32_t> listed;
    for (const Element& element : issue->elements) {
      listed.push_back(element.vertices[0] - first);
      CHECK(element.is_known == (listed.back() < known_below));
    }
    return listed;
  };
  CHECK(isolated(0, 3) == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(isolated(498, 4) == std::vector<std::uint32_t>{498, 499, 0, 1});
  CHECK(isolated(400, 3) == std::vector<std::uint32_t>{400, 401, 402});
  CHECK(isolated(2, 3) == std::vector<std::uint32_t>{2, 3, 4});
  CHECK(isolated(1000, 2) == std::vector<std::uint32_t>{0, 1});
  CHECK(isolated(499, 0).empty());
}
