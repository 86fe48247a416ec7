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
  json["effect"] = {{"distance", action.distance}, {"volume_change", action.volume_change}};  // an infinite distance is null
  return json;
}

void add_account(const RepairAccount& account, Json& json) {
  json["actions"] = Json::array();
  for (const RepairAction& action : account.actions)
    json["actions"].push_back(to_json(action));
  json["effect"] = {{"distance", account.distance},
                    {"volume_before", account.volume_before},
                    {"volume_after", account.volume_after},
                    {"faces_before", account.faces_before},
                    {"faces_after", account.faces_after}};
}

}  // namespace

std::string compile_report_json(const Compiled& compiled) {
  if (!compiled.repair) return report_json({compiled.report});
  Json document = Json::parse(report_json({compiled.report}));
  Json& entry = document["files"][0]["repair"];
  entry["level"] = level_name(compiled.repair->level);
  entry["found"] = compiled.repair->found;
  add_account(*compiled.repair, entry);
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string repair_json(const Repaired& repaired, const std::string& output) {
  Json json;
  json["tool"] = "fdcg";
  json["written"] = output.empty() ? Json(nullptr) : Json(output);
  json["verdict"] = repaired.after.passes() ? "pass" : "fail";
  const double metres = repaired.soup.metres_per_unit;
  json["metres_per_unit"] = metres > 0 ? Json(metres) : Json(nullptr);
  json["read_with_weld"] = repaired.read_with == Weld::Kind::none ? "none" : "exact";
  add_account(repaired, json);
  json["before"] = report_entry(repaired.before);
  json["after"] = report_entry(repaired.after);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fdcg::bake
