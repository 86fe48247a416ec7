// SPDX-License-Identifier: Apache-2.0
// The official schema is checked by tests/contract/validate_cli_test.py; these are properties that the schema cannot express.
#include <nlohmann/json.hpp>
#include <set>

#include "catch.hpp"
#include "sample_report.hpp"

using namespace fdcg::bake;
using fdcg::test::sample_report;
using fdcg::test::unreadable_report;
using nlohmann::json;

namespace {

json run_of(const std::vector<Report>& reports, const ReportOptions& options = {}) {
  const json document = json::parse(report_string(ReportFormat::sarif, reports, options));
  CHECK(document["version"] == "2.1.0");
  REQUIRE(document["runs"].size() == 1);
  return document["runs"][0];
}

}  // namespace

TEST_CASE("SARIF: one result per rule has the exact total, all listed places, and links to the first") {
  const json run = run_of({sample_report()});
  REQUIRE(run["results"].size() == 3);
  const json& error = run["results"][0];
  CHECK(error["ruleId"] == "non-manifold-edge");
  CHECK(error["level"] == "error");
  CHECK(error["occurrenceCount"] == 300);
  CHECK(error["locations"].size() == 100);
  CHECK(error["locations"][0]["physicalLocation"]["region"]["startLine"] == 10);
  CHECK(error["locations"][99]["physicalLocation"]["region"]["startLine"] == 109);
  CHECK(error["locations"][1]["properties"]["faces"] == json::array({1, 2}));
  CHECK(error["locations"][1]["properties"]["point"] == json::array({0.1, -1.0, 1e300}));
  CHECK(error["locations"][1]["properties"]["fingerprint"] == "0123456789abcdf0");
  std::set<std::string> kinds;
  for (const json& logical : error["locations"][1]["logicalLocations"])
    kinds.insert(logical["kind"]);
  CHECK(kinds == std::set<std::string>{"part", "face", "edge", "vertex"});
  CHECK(run["results"][2]["locations"].size() == 1);  // code scanning drops results without one
  CHECK(run["results"][2]["locations"][0]["physicalLocation"]["region"]["startLine"] == 1);

  const std::string text = error["message"]["text"];
  CHECK(text.find("Split \\[them\\].") != std::string::npos);  // brackets mean links
  for (const json& related : error["relatedLocations"]) {
    CHECK(text.find("](" + std::to_string(related["id"].get<int>()) + ")") != std::string::npos);
  }
  CHECK(error["relatedLocations"].size() == 10);
  CHECK(text.find("and 290 more") != std::string::npos);
}

TEST_CASE("SARIF: every rule of the catalogue is described, and results point to it") {
  const json run = run_of({sample_report()});
  const json& described = run["tool"]["driver"]["rules"];
  REQUIRE(described.size() == rules().size());
  for (std::size_t i = 0; i < rules().size(); ++i) {
    CHECK(described[i]["id"] == rules()[i].name);
    CHECK(described[i]["help"]["text"].get<std::string>().find(rules()[i].remedy) != std::string::npos);
    const char* const levels[] = {"note", "warning", "error"};
    CHECK(described[i]["defaultConfiguration"]["level"] == levels[static_cast<int>(rules()[i].severity)]);
  }
  for (const json& result : run["results"])
    CHECK(described[result["ruleIndex"].get<std::size_t>()]["id"] == result["ruleId"]);
}

TEST_CASE("SARIF: results per element add up to the exact total and have distinct fingerprints") {
  ReportOptions options;
  options.result_per_element = true;
  Report report = sample_report();
  report.issues[0].elements[1].fingerprint = report.issues[0].elements[0].fingerprint;
  const json run = run_of({report}, options);
  std::map<std::string, std::uint64_t> totals;
  std::set<std::string> prints;
  for (const json& result : run["results"]) {
    totals[result["ruleId"]] += result["occurrenceCount"].get<std::uint64_t>();
    CHECK(result["locations"].size() == 1);
    CHECK(prints
              .insert(result["ruleId"].get<std::string>() +
                      result["partialFingerprints"]["primaryLocationLineHash"].get<std::string>())
              .second);
  }
  CHECK(totals ==
        std::map<std::string, std::uint64_t>{{"non-manifold-edge", 300}, {"boundary-edge", 1}, {"isolated-vertex", 7}});
  CHECK(run["results"][98]["baselineState"] == "unchanged");
  CHECK(run["results"][97]["baselineState"] == "new");
  CHECK(run["results"].size() == 101 + 1 + 1);
}

TEST_CASE("SARIF: known and allowed findings are suppressed, others are not") {
  const json run = run_of({sample_report()});
  CHECK(run["results"][0]["baselineState"] == "updated");  // 2 of 300 are known
  CHECK(run["results"][0]["suppressions"].empty());
  CHECK(run["results"][1]["suppressions"][0]["justification"] == "the rule is allowed");
  CHECK(run["results"][2]["baselineState"] == "unchanged");
  CHECK(run["results"][2]["suppressions"][0]["justification"] == "the baseline has it");
  Report plain = sample_report();
  plain.has_baseline = false;
  CHECK(run_of({plain})["results"][0].count("baselineState") == 0);
}

TEST_CASE("SARIF: the fingerprint of a rule's result does not depend on its findings, and differs between files") {
  const auto print = [](const Report& report) {
    return run_of({report})["results"][0]["partialFingerprints"]["primaryLocationLineHash"].get<std::string>();
  };
  Report moved = sample_report(), other = sample_report();
  moved.issues[0].total = 5;
  moved.issues[0].elements.resize(2);
  moved.issues[0].elements[0].line = 77;
  other.file = "other.obj";
  CHECK(print(moved) == print(sample_report()));
  CHECK(print(other) != print(sample_report()));
}

TEST_CASE("SARIF: files are URIs, relative below the source root, and the run has its exit code") {
  ReportOptions options;
  options.source_root = "/data";
  Report inside = sample_report();
  inside.file = "/data/x y.obj";
  Report outside = sample_report();
  outside.file = "../x.obj";
  const json run = run_of({sample_report(), unreadable_report(), inside, outside}, options);
  std::vector<std::string> uris;
  for (const json& artifact : run["artifacts"]) {
    uris.push_back(artifact["location"]["uri"]);
    CHECK((artifact["location"].count("uriBaseId") == 1) == (uris.back().rfind("file:", 0) != 0));
  }
  CHECK(uris == std::vector<std::string>{"meshes/a%20b%23%FF%3C%26%3E%22%27%01%20%5B7%5D.obj", "gone.stl", "x%20y.obj",
                                         "file:///x.obj"});
  CHECK(run["artifacts"][0]["properties"]["config"] == "meshes/.fdcg-validate.json");
  CHECK(run["artifacts"][0]["properties"]["ignored line elements"] == 3);
  CHECK(run["invocations"][0]["exitCode"] == 3);
  CHECK(run["invocations"][0]["executionSuccessful"] == false);
  CHECK(run_of({sample_report()})["invocations"][0]["exitCode"] == 1);
  CHECK(run_of({})["invocations"][0]["exitCode"] == 0);
}
