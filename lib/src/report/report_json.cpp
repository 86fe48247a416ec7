// SPDX-License-Identifier: Apache-2.0
#include "report/report_json.hpp"

#include <algorithm>
#include <utility>

#include "fdcg/fdcg.h"
#include "fdcg/results.hpp"
#include "report/report_parts.hpp"

namespace fdcg::bake {
namespace {

using enum JsonWriter::Layout;

template <class List>
void write_list(JsonWriter& json, std::string_view key, const List& list) {
  json.begin_array(key, one_line);
  for (const auto& item : list)
    json.value(item);
  json.end_array();
}

void write_issue(JsonWriter& json, const Issue& issue, const std::function<void(const Issue&)>& elements) {
  json.begin_object();
  json.member("rule", issue.rule);
  json.member("severity", name_of(issue.severity));
  json.member("total", issue.total);
  if (issue.is_at_least) json.member("at_least", true);
  json.member("known", issue.known);
  json.member("message", issue.message);
  json.begin_array("elements");
  elements(issue);
  json.end_array();
  json.end_object();
}

// All but the file's name.
void write_members(JsonWriter& json, const Report& report, const std::function<void(const Issue&)>& elements) {
  json.member("verdict", report.passes() ? "pass" : "fail");
  json.member("vertices", report.vertices);
  json.member("faces", report.faces);
  json.member("kept_faces", report.kept_faces);
  json.member("components", report.components);
  json.begin_array("ignored");
  for (const Ignored& ignored : report.ignored) {
    json.begin_object(one_line);
    json.member("what", ignored.what);
    json.member("count", ignored.count);
    json.end_object();
  }
  json.end_array();
  json.begin_array("issues");
  for (const Issue& issue : report.issues)
    write_issue(json, issue, elements);
  json.end_array();
  write_list(json, "checks", report.checks);
  write_list(json, "allowed", report.allowed);
  json.member("fail_on", report.fail_on ? name_of(*report.fail_on) : "never");
  if (!report.config.empty()) json.member("config", report.config);
  if (report.has_baseline) {
    json.begin_object("resolved", one_line);
    for (const auto& [rule, total] : report.resolved)
      json.member(rule, total);
    json.end_object();
  }
}

class JsonReportWriter final : public ReportWriter {
 public:
  JsonReportWriter(Write write, std::size_t max_elements) : write_(std::move(write)), max_elements_(max_elements) {
    begin_json_document(json_);
  }
  void add(const Report& report) override {
    write_json_file(json_, report, [&](const Issue& issue) {
      for (std::size_t i = 0; i < std::min(issue.elements.size(), max_elements_); ++i) {
        write_json_element(json_, issue.elements[i]);
        if (buffer_.size() > kPieceBytes) flush();
      }
    });
    flush();
  }
  void finish(int /*exit_code*/) override {
    end_json_document(json_, buffer_);
    flush();
  }

 private:
  static constexpr std::size_t kPieceBytes = std::size_t{1} << 18;
  void flush() {
    write_(buffer_);
    buffer_.clear();
  }

  Write write_;
  std::size_t max_elements_;
  std::string buffer_;
  JsonWriter json_{buffer_};
};

}  // namespace

void begin_json_document(JsonWriter& json) {
  json.begin_object();
  json.member("tool", "fdcg");
  json.member("version", FDCG_VERSION_STRING);
  json.begin_array("files");
}

void end_json_document(JsonWriter& json, std::string& out) {
  json.end_array();
  json.end_object();
  out += '\n';
}

void write_json_element(JsonWriter& json, const Element& element) {
  json.begin_object(one_line);
  write_list(json, "faces", element.faces);
  if (element.more_faces != 0) json.member("more_faces", element.more_faces);
  json.begin_array("edges");
  for (const auto& edge : element.edges) {
    json.begin_array();
    json.value(edge[0]);
    json.value(edge[1]);
    json.end_array();
  }
  json.end_array();
  write_list(json, "vertices", element.vertices);
  if (element.point) {
    json.begin_array("point");
    for (const double c : {element.point->x, element.point->y, element.point->z})
      json.value(c);
    json.end_array();
  }
  if (element.line) json.member("line", *element.line);
  if (!element.part.empty()) json.member("part", valid_utf8(element.part, kLongestName));
  json.member("fingerprint", fingerprint_text(element.fingerprint));
  if (element.is_known) json.member("known", true);
  json.end_object();
}

void write_json_file(JsonWriter& json, const Report& report, const std::function<void(const Issue&)>& elements) {
  json.begin_object();
  json.member("file", report.file);
  write_members(json, report, elements);
  json.end_object();
}

std::string report_line(const Report& report) {
  std::string out;
  JsonWriter json(out);
  json.begin_object(one_line);
  write_members(json, report, [&](const Issue& issue) {
    for (const Element& element : issue.elements)
      write_json_element(json, element);
  });
  json.end_object();
  return out;
}

std::unique_ptr<ReportWriter> make_json_writer(Write write, const ReportOptions& options) {
  return std::make_unique<JsonReportWriter>(std::move(write), options.max_elements);
}

}  // namespace fdcg::bake
