// SPDX-License-Identifier: Apache-2.0
// repair() as JSON; schemas/repair-report.schema.json describes it.
#include <nlohmann/json.hpp>

#include "fdcg/bake.hpp"

namespace fdcg::bake {
namespace {

using Json = nlohmann::ordered_json;

// The elements in the format of validate's report, written by the same code.
Json elements_json(const std::vector<Element>& elements) {
  Report report;
  Issue& issue = report.issues.emplace_back();
  issue.rule = rules().front().name;  // any rule: only the elements are used
  issue.total = elements.size();
  issue.elements = elements;
  return Json::parse(report_json({report}))["files"][0]["issues"][0]["elements"];
}

Json report_entry(const Report& report) {
  return Json::parse(report_json({report}))["files"][0];
}

Json to_json(const RepairAction& action) {
  Json json;
  json["name"] = action.name;
  json["total"] = action.total;
  json["message"] = action.message;
  json["elements"] = elements_json(action.elements);
  json["left"]["total"] = action.left;
  json["left"]["message"] = action.left_message;
  json["left"]["elements"] = elements_json(action.left_elements);
  return json;
}

}  // namespace

std::string repair_json(const Repaired& repaired, const std::string& output) {
  Json json;
  json["tool"] = "fdcg";
  json["written"] = output.empty() ? Json(nullptr) : Json(output);
  json["verdict"] = repaired.after.passes() ? "pass" : "fail";
  json["read_with_weld"] = repaired.read_with == Weld::Kind::none ? "none" : "exact";
  json["actions"] = Json::array();
  for (const RepairAction& action : repaired.actions)
    json["actions"].push_back(to_json(action));
  json["before"] = report_entry(repaired.before);
  json["after"] = report_entry(repaired.after);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fdcg::bake
