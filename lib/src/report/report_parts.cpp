// SPDX-License-Identifier: Apache-2.0
#include "report/report_parts.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "shared/text.hpp"

namespace fdcg::bake {
namespace {

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

}  // namespace

std::string_view name_of(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

std::string counted(std::uint64_t n, std::string_view one, std::string_view many) {
  return std::to_string(n) + " " + std::string(n == 1 ? one : many);
}

std::string place_of(const Element& element) {
  std::string out;
  if (element.line) out += ", line " + std::to_string(*element.line);
  const auto index = [](std::uint32_t i) { return std::to_string(i); };
  append_list(out, "vertex", "vertices", element.vertices, index);
  append_list(out, "edge", "edges", element.edges,
              [](const std::array<std::uint32_t, 2>& e) { return std::to_string(e[0]) + "-" + std::to_string(e[1]); });
  append_list(out, "face", "faces", element.faces, index);
  if (element.more_faces != 0) out += " (" + std::to_string(element.faces.size() + element.more_faces) + " in all)";
  if (!element.part.empty()) out += ", part \"" + printable(element.part, kLongestName) + "\"";
  if (element.point) {
    out += ", at (" + number(element.point->x) + ", " + number(element.point->y) + ", " + number(element.point->z) + ")";
  }
  return out.empty() ? "" : out.substr(2);
}

std::string fingerprint_text(std::uint64_t fingerprint) {
  constexpr int kDigits = 16;
  std::string out(kDigits, '0');
  for (int i = kDigits - 1; i >= 0; --i, fingerprint >>= 4)
    out[static_cast<std::size_t>(i)] = "0123456789abcdef"[fingerprint & 15];
  return out;
}

bool is_import_failure(const Report& report) {
  return report.faces == 0 && std::any_of(report.issues.begin(), report.issues.end(), [](const Issue& issue) {
           return issue.rule == "unreadable" || issue.rule == "empty-mesh";
         });
}

bool fails(const Report& report, const Issue& issue) {
  return report.fail_on && issue.severity >= *report.fail_on && issue.total > issue.known &&
         report.allowed.count(issue.rule) == 0;
}

}  // namespace fdcg::bake
