// SPDX-License-Identifier: Apache-2.0
#include "report_reader.hpp"

#include <charconv>
#include <limits>
#include <string>
#include <string_view>

#include "validate_settings.hpp"

namespace fdcg::tools {
namespace {

using Node = simdjson::dom::element;

[[noreturn]] void wrong_type() {
  throw simdjson::simdjson_error(simdjson::INCORRECT_TYPE);
}

double coordinate(Node json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : double(json);
}

std::uint32_t index_of(Node json) {
  const std::uint64_t value(json);
  if (value > std::numeric_limits<std::uint32_t>::max()) wrong_type();
  return static_cast<std::uint32_t>(value);
}

std::string text_of(Node json) {
  return std::string(std::string_view(json));
}

std::uint64_t number_or_0(Node json, std::string_view name) {
  Node member;
  return json[name].get(member) == simdjson::SUCCESS ? std::uint64_t(member) : 0;
}

bool is_set(Node json, std::string_view name) {
  Node member;
  return json[name].get(member) == simdjson::SUCCESS && bool(member);
}

bake::Severity read_severity(Node json) {
  const auto severity = parse_fail_on(text_of(json));
  if (!severity || !*severity) wrong_type();
  return **severity;
}

bake::Element read_element(Node json) {
  bake::Element element;
  for (const Node face : json["faces"])
    element.faces.push_back(index_of(face));
  element.more_faces = number_or_0(json, "more_faces");
  for (const Node edge : json["edges"])
    element.edges.push_back({index_of(edge.at(0)), index_of(edge.at(1))});
  for (const Node vertex : json["vertices"])
    element.vertices.push_back(index_of(vertex));
  Node member;
  if (json["point"].get(member) == simdjson::SUCCESS)
    element.point = bake::Vec3{coordinate(member.at(0)), coordinate(member.at(1)), coordinate(member.at(2))};
  if (json["line"].get(member) == simdjson::SUCCESS) element.line = index_of(member);
  if (json["part"].get(member) == simdjson::SUCCESS) element.part = text_of(member);
  const std::string_view digits(json["fingerprint"]);
  if (std::from_chars(digits.data(), digits.data() + digits.size(), element.fingerprint, 16).ec != std::errc{}) wrong_type();
  element.is_known = is_set(json, "known");
  return element;
}

bake::Issue read_issue(Node json) {
  bake::Issue issue;
  issue.rule = text_of(json["rule"]);
  issue.severity = read_severity(json["severity"]);
  issue.total = json["total"];
  issue.is_at_least = is_set(json, "at_least");
  issue.known = json["known"];
  issue.message = text_of(json["message"]);
  for (const Node element : json["elements"])
    issue.elements.push_back(read_element(element));
  return issue;
}

}  // namespace

bake::Report read_report(Node json) {
  bake::Report report;
  report.vertices = json["vertices"];
  report.faces = json["faces"];
  report.kept_faces = json["kept_faces"];
  report.components = json["components"];
  for (const Node ignored : json["ignored"])
    report.ignored.push_back({text_of(ignored["what"]), ignored["count"]});
  for (const Node issue : json["issues"])
    report.issues.push_back(read_issue(issue));
  for (const Node check : json["checks"])
    report.checks.push_back(text_of(check));
  for (const Node rule : json["allowed"])
    report.allowed.insert(text_of(rule));
  if (text_of(json["fail_on"]) == "never") {
    report.fail_on.reset();
  } else {
    report.fail_on = read_severity(json["fail_on"]);
  }
  return report;
}

}  // namespace fdcg::tools
