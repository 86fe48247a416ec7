// SPDX-License-Identifier: Apache-2.0
// What people and scripts read of a report. schemas/validate-report.schema.json describes the JSON.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fdcg/bake.hpp"

namespace fdcg::bake {
namespace {

using Json = nlohmann::ordered_json;

std::string_view name_of(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

// ---- text

constexpr std::string_view kRed = "\033[31m", kYellow = "\033[33m", kGreen = "\033[32m", kBold = "\033[1m", kPlain = "\033[0m";

std::string painted(std::string_view text, std::string_view colour, bool on) {
  if (!on) return std::string(text);
  return std::string(colour) + std::string(text) + std::string(kPlain);
}

// The shortest digits that read back as the same number.
std::string number(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x < 0 ? "-inf" : "inf";
  char buffer[32];
  return {buffer, std::to_chars(std::begin(buffer), std::end(buffer), x).ptr};
}

template <class List, class Print>
void append_list(std::string& out, std::string_view one, std::string_view many, const List& list, Print print) {
  constexpr std::size_t kShown = 6;
  if (list.empty()) return;
  out += ", ";
  out += list.size() == 1 ? one : many;
  for (std::size_t i = 0; i < std::min(list.size(), kShown); ++i)
    out += ' ' + print(list[i]);
  if (list.size() > kShown) out += " ...";
}

std::string line_of(const Element& element) {
  std::string out;
  if (element.line) out += ", line " + std::to_string(*element.line);
  const auto index = [](std::uint32_t i) { return std::to_string(i); };
  append_list(out, "vertex", "vertices", element.vertices, index);
  append_list(out, "edge", "edges", element.edges,
              [](const std::array<std::uint32_t, 2>& e) { return std::to_string(e[0]) + "-" + std::to_string(e[1]); });
  append_list(out, "face", "faces", element.faces, index);
  if (element.more_faces != 0) out += " (" + std::to_string(element.faces.size() + element.more_faces) + " in all)";
  if (element.point) {
    out += ", at (" + number(element.point->x) + ", " + number(element.point->y) + ", " + number(element.point->z) + ")";
  }
  return out.empty() ? "" : out.substr(2);
}

void append_issue(std::string& out, const Issue& issue, bool is_allowed, bool colour) {
  constexpr std::size_t kShown = 3;
  const std::string_view paint = issue.severity == Severity::error     ? kRed
                                 : issue.severity == Severity::warning ? kYellow
                                                                       : kBold;
  out += "  " + painted(name_of(issue.severity), paint, colour) + " " + painted(issue.rule, kBold, colour) +
         (is_allowed ? " (allowed)" : "") + ": " + issue.message + "\n";
  const std::size_t shown = std::min(issue.elements.size(), kShown);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string where = line_of(issue.elements[i]);
    if (!where.empty()) out += "    " + where + "\n";
  }
  if (shown > 0 && issue.total > shown) out += "    and " + std::to_string(issue.total - shown) + " more\n";
}

std::string counted(std::uint64_t n, std::string_view one, std::string_view many) {
  return std::to_string(n) + " " + std::string(n == 1 ? one : many);
}

// ---- JSON

// A text as valid UTF-8: a path may hold any bytes, JSON may not.
std::string utf8(const std::string& text) {
  const Json checked = text;
  return Json::parse(checked.dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Json finite_or_null(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json to_json(const Element& element) {
  Json json = Json::object();
  json["faces"] = element.faces;
  if (element.more_faces != 0) json["more_faces"] = element.more_faces;
  json["edges"] = element.edges;
  json["vertices"] = element.vertices;
  if (element.point) {
    json["point"] = {finite_or_null(element.point->x), finite_or_null(element.point->y), finite_or_null(element.point->z)};
  }
  if (element.line) json["line"] = *element.line;
  return json;
}

Json to_json(const Report& report, std::size_t max_elements) {
  Json json;
  json["file"] = utf8(report.file);
  json["verdict"] = report.passes() ? "pass" : "fail";
  json["vertices"] = report.vertices;
  json["faces"] = report.faces;
  json["components"] = report.components;
  json["issues"] = Json::array();
  for (const Issue& issue : report.issues) {
    Json entry;
    entry["rule"] = issue.rule;
    entry["severity"] = name_of(issue.severity);
    entry["total"] = issue.total;
    entry["message"] = utf8(issue.message);
    entry["elements"] = Json::array();
    for (std::size_t i = 0; i < std::min(issue.elements.size(), max_elements); ++i)
      entry["elements"].push_back(to_json(issue.elements[i]));
    json["issues"].push_back(std::move(entry));
  }
  json["checks"] = report.checks;
  json["allowed"] = report.allowed;
  return json;
}

}  // namespace

bool Report::passes(std::optional<Severity> level) const {
  return !level || std::none_of(issues.begin(), issues.end(), [&](const Issue& issue) {
    return issue.total > issue.known && issue.severity >= *level && allowed.count(issue.rule) == 0;
  });
}

std::string report_text(const Report& report, bool colour) {
  const bool passes = report.passes();
  std::string out = painted(report.file, kBold, colour) + ": " +
                    painted(passes ? "pass" : "fail", passes ? kGreen : kRed, colour) + " (" +
                    counted(report.vertices, "vertex", "vertices") + ", " + counted(report.faces, "face", "faces") + ", " +
                    counted(report.components, "component", "components") + ")\n";
  for (const Issue& issue : report.issues)
    append_issue(out, issue, report.allowed.count(issue.rule) != 0, colour);
  return out;
}

std::string report_json(const std::vector<Report>& reports, std::size_t max_elements) {
  Json json;
  json["tool"] = "fdcg";
  json["files"] = Json::array();
  for (const Report& report : reports)
    json["files"].push_back(to_json(report, max_elements));
  return json.dump(1) + "\n";
}

}  // namespace fdcg::bake
