// SPDX-License-Identifier: Apache-2.0
// One result per rule and file: its occurrenceCount is the exact total, its locations are the listed elements, and the message
// links to the first few of them, since code scanning shows only the first location otherwise. With result_per_element each
// listed element is a separate result, and one more result counts those that are not listed.
#include "report/sarif_results.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "base/file_uri.hpp"
#include "report/report_parts.hpp"

namespace fdcg::bake {
namespace {

using enum JsonWriter::Layout;

constexpr std::size_t kLinked = 10;          // places that a message links to
constexpr std::size_t kNamedInLocation = 5;  // logical locations of an element; all of its indices are in the properties
// Limit of places in one file's results: where many rules have findings, each lists fewer, and a report stays below a megabyte.
constexpr std::size_t kPlacesOfRules = 750, kPlacesOfElements = 520;

// 64-bit FNV-1a, chosen because it is stable between versions and machines.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

// Plain text of a message: brackets and backslashes mean links there (SARIF 3.11.6).
std::string escaped_for_message(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

template <class List>
void write_indices(JsonWriter& json, std::string_view key, const List& list) {
  if (list.empty()) return;
  json.begin_array(key, one_line);
  for (const auto& item : list)
    json.value(item);
  json.end_array();
}

// Writes the results of one file.
class ResultWriter {
 public:
  ResultWriter(JsonWriter& json, const Report& report, const std::string& uri, std::size_t artifact,
               const ReportOptions& options)
      : json_(json), report_(report), uri_(uri), artifact_(artifact), options_(options) {}

  void write_all() {
    for (const Issue& issue : report_.issues) {
      if (options_.result_per_element) {
        write_each(issue);
      } else {
        write_aggregate(issue);
      }
    }
  }

 private:
  [[nodiscard]] std::size_t listed(const Issue& issue) const {
    const std::size_t most = (options_.result_per_element ? kPlacesOfElements : kPlacesOfRules) / report_.issues.size();
    return std::min({issue.elements.size(), options_.max_elements, most});
  }

  void write_aggregate(const Issue& issue) {
    const std::size_t count = listed(issue);
    begin_result(issue, issue.total);
    std::string text = escaped_for_message(issue.message);
    const std::size_t linked = std::min(count, kLinked);
    for (std::size_t i = 0; i < linked; ++i)
      text += (i == 0 ? " Found at: [" : "; [") + escaped_for_message(place_of(issue.elements[i])) + "](" +
              std::to_string(i + 1) + ")";
    if (linked != 0) text += issue.total > linked ? "; and " + std::to_string(issue.total - linked) + " more." : ".";
    write_sarif_text(json_, "message", text);
    json_.begin_array("locations");
    for (std::size_t i = 0; i < count; ++i)
      write_location(issue.elements[i], {});
    if (count == 0) write_file_location();
    json_.end_array();
    if (linked != 0) {
      json_.begin_array("relatedLocations");
      for (std::size_t i = 0; i < linked; ++i)
        write_location(issue.elements[i], i + 1);
      json_.end_array();
    }
    write_fingerprint(hash_of(issue.rule + "\n" + uri_), 1);
    write_states(issue, issue.known, issue.total);
    json_.begin_object("properties", one_line);
    json_.member("known", issue.known);
    json_.end_object();
    json_.end_object();
  }

  void write_each(const Issue& issue) {
    std::map<std::uint64_t, unsigned> seen;  // findings may share a fingerprint; code scanning wants them numbered
    const std::size_t count = listed(issue);
    std::uint64_t known = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Element& element = issue.elements[i];
      const Rule* const rule = find_rule(issue.rule);
      const std::string text = place_of(element) + ". " + std::string(rule == nullptr ? issue.message : rule->remedy);
      begin_result(issue, 1);
      write_sarif_text(json_, "message", escaped_for_message(issue.rule + ": " + text));
      json_.begin_array("locations");
      write_location(element, {});
      json_.end_array();
      write_fingerprint(element.fingerprint, ++seen[element.fingerprint]);
      write_states(issue, element.is_known ? 1 : 0, 1);
      json_.end_object();
      known += element.is_known ? 1 : 0;
    }
    if (issue.total > count) write_rest(issue, issue.total - count, issue.known - known);
  }

  // A result for the elements not listed, so that the sum of a rule's counts is its total.
  void write_rest(const Issue& issue, std::uint64_t rest, std::uint64_t known) {
    begin_result(issue, rest);
    const bool is_all = rest == issue.total;
    write_sarif_text(
        json_, "message",
        escaped_for_message(is_all ? issue.message : std::to_string(rest) + " more of " + issue.rule + ". " + issue.message));
    json_.begin_array("locations");
    write_file_location();
    json_.end_array();
    write_fingerprint(hash_of(issue.rule + "\n" + uri_), 1);
    write_states(issue, known, rest);
    json_.end_object();
  }

  void begin_result(const Issue& issue, std::uint64_t count) {
    json_.begin_object();
    json_.member("ruleId", issue.rule);
    if (const Rule* const rule = find_rule(issue.rule)) json_.member("ruleIndex", rule - rules().data());
    json_.member("level", name_of(issue.severity));
    json_.member("occurrenceCount", count);
  }

  void write_artifact() {
    json_.begin_object("artifactLocation");
    json_.member("uri", uri_);
    if (is_relative_uri(uri_)) json_.member("uriBaseId", kSarifRoot);
    json_.member("index", artifact_);
    json_.end_object();
  }
  void write_file_location() {
    json_.begin_object(one_line);
    json_.begin_object("physicalLocation");
    write_artifact();
    write_region(1);
    json_.end_object();
    json_.end_object();
  }
  // Code scanning shows no result without a line: of binary files, and of what has no line, it is the first.
  void write_region(std::uint32_t line) {
    json_.begin_object("region");
    json_.member("startLine", line);
    json_.end_object();
  }

  void write_location(const Element& element, std::optional<std::size_t> id) {
    json_.begin_object(one_line);
    if (id) json_.member("id", *id);
    json_.begin_object("physicalLocation");
    write_artifact();
    write_region(element.line.value_or(1));
    json_.end_object();
    if (id) {
      json_.end_object();
      return;
    }
    write_logical_locations(element);
    write_properties(element);
    json_.end_object();
  }

  void write_logical_locations(const Element& element) {
    const std::string part = valid_utf8(element.part, kLongestName);
    std::vector<std::pair<std::string, std::string>> names;  // name, kind
    if (!part.empty()) names.emplace_back(part, "part");
    const auto add = [&](const std::string& index, const char* kind) {
      std::pair<std::string, std::string> name(std::string(kind) + " " + index, kind);
      const bool is_new = std::find(names.begin(), names.end(), name) == names.end();
      if (names.size() < kNamedInLocation && is_new) names.push_back(std::move(name));
    };
    for (const std::uint32_t face : element.faces)
      add(std::to_string(face), "face");
    for (const auto& edge : element.edges)
      add(std::to_string(edge[0]) + "-" + std::to_string(edge[1]), "edge");
    for (const std::uint32_t vertex : element.vertices)
      add(std::to_string(vertex), "vertex");
    if (names.empty()) return;
    json_.begin_array("logicalLocations");
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto& [name, kind] = names[i];
      json_.begin_object();
      json_.member("name", name);
      if (!part.empty() && i == 1) json_.member("fullyQualifiedName", part + "/" + name);  // once only, since names may be long
      json_.member("kind", kind);
      json_.end_object();
    }
    json_.end_array();
  }

  void write_properties(const Element& element) {
    json_.begin_object("properties");
    write_indices(json_, "faces", element.faces);
    if (element.more_faces != 0) json_.member("more_faces", element.more_faces);
    if (!element.edges.empty()) {
      json_.begin_array("edges");
      for (const auto& edge : element.edges) {
        json_.begin_array();
        json_.value(edge[0]);
        json_.value(edge[1]);
        json_.end_array();
      }
      json_.end_array();
    }
    write_indices(json_, "vertices", element.vertices);
    if (element.point) write_indices(json_, "point", std::array{element.point->x, element.point->y, element.point->z});
    json_.member("fingerprint", fingerprint_text(element.fingerprint));
    if (report_.has_baseline) json_.member("known", element.is_known);
    json_.end_object();
  }

  // primaryLocationLineHash is the one that code scanning compares; it would hash the text around the line, of which binary
  // files have none.
  void write_fingerprint(std::uint64_t fingerprint, unsigned number) {
    const std::string text = fingerprint_text(fingerprint) + ":" + std::to_string(number);
    json_.begin_object("partialFingerprints", one_line);
    json_.member("fdcg/v1", text);
    json_.member("primaryLocationLineHash", text);
    json_.end_object();
  }

  void write_states(const Issue& issue, std::uint64_t known, std::uint64_t total) {
    const bool is_allowed = report_.allowed.count(issue.rule) != 0;
    const bool is_known = known == total;
    if (report_.has_baseline) json_.member("baselineState", is_known ? "unchanged" : known == 0 ? "new" : "updated");
    json_.begin_array("suppressions", one_line);
    if (is_allowed || (report_.has_baseline && is_known)) {
      json_.begin_object();
      json_.member("kind", "external");
      json_.member("status", "accepted");
      json_.member("justification", is_allowed ? "the rule is allowed" : "the baseline has it");
      json_.end_object();
    }
    json_.end_array();
  }

  JsonWriter& json_;
  const Report& report_;
  const std::string& uri_;
  std::size_t artifact_;
  const ReportOptions& options_;
};

}  // namespace

void write_sarif_results(JsonWriter& json, const Report& report, const std::string& uri, std::size_t artifact,
                         const ReportOptions& options) {
  ResultWriter(json, report, uri, artifact, options).write_all();
}

}  // namespace fdcg::bake
