// SPDX-License-Identifier: Apache-2.0
#include "report_reader.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "validate_settings.hpp"

namespace fdcg::tools {
namespace {

using Json = nlohmann::ordered_json;

double coordinate(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

bake::Element read_element(const Json& json) {
  bake::Element element;
  json.at("faces").get_to(element.faces);
  element.more_faces = json.value("more_faces", std::uint64_t{0});
  json.at("edges").get_to(element.edges);
  json.at("vertices").get_to(element.vertices);
  if (const auto point = json.find("point"); point != json.end())
    element.point = bake::Vec3{coordinate(point->at(0)), coordinate(point->at(1)), coordinate(point->at(2))};
  if (const auto line = json.find("line"); line != json.end()) element.line = line->get<std::uint32_t>();
  element.part = json.value("part", std::string());
  element.fingerprint = std::stoull(json.at("fingerprint").get_ref<const std::string&>(), nullptr, 16);
  element.is_known = json.value("known", false);
  return element;
}

bake::Severity read_severity(const Json& json) {
  return parse_fail_on(json.get_ref<const std::string&>())->value();
}

bake::Issue read_issue(const Json& json) {
  bake::Issue issue;
  json.at("rule").get_to(issue.rule);
  issue.severity = read_severity(json.at("severity"));
  json.at("total").get_to(issue.total);
  issue.is_at_least = json.value("at_least", false);
  json.at("known").get_to(issue.known);
  json.at("message").get_to(issue.message);
  for (const Json& element : json.at("elements"))
    issue.elements.push_back(read_element(element));
  return issue;
}

}  // namespace

bake::Report read_report(const Json& json) {
  bake::Report report;
  json.at("vertices").get_to(report.vertices);
  json.at("faces").get_to(report.faces);
  json.at("kept_faces").get_to(report.kept_faces);
  json.at("components").get_to(report.components);
  for (const Json& ignored : json.at("ignored"))
    report.ignored.push_back({ignored.at("what").get<std::string>(), ignored.at("count").get<std::uint64_t>()});
  for (const Json& issue : json.at("issues"))
    report.issues.push_back(read_issue(issue));
  json.at("checks").get_to(report.checks);
  json.at("allowed").get_to(report.allowed);
  const std::string& fail_on = json.at("fail_on").get_ref<const std::string&>();
  report.fail_on = fail_on == "never" ? std::nullopt : std::optional(read_severity(json.at("fail_on")));
  return report;
}

}  // namespace fdcg::tools
