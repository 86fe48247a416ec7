// SPDX-License-Identifier: Apache-2.0
// SARIF 2.1.0 (OASIS, errata 01): the tool with its rules, the results file by file, the files, the exit code.
#include <utility>

#include "base/file_uri.hpp"
#include "base/json_writer.hpp"
#include "fdcg/fdcg.h"
#include "report/report_parts.hpp"
#include "report/sarif_results.hpp"

namespace fdcg::bake {
namespace {

using enum JsonWriter::Layout;

constexpr std::string_view kSchemaUri =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";

void write_rule(JsonWriter& json, const Rule& rule) {
  const std::string meaning(rule.meaning), why(rule.why), remedy(rule.remedy);
  json.begin_object();
  json.member("id", rule.name);
  write_sarif_text(json, "shortDescription", "Counts " + meaning + ".");
  write_sarif_text(json, "fullDescription", "Counts " + meaning + ". " + why);
  json.begin_object("help");
  json.member("text", "Why it matters: " + why + "\nWhat to do: " + remedy);
  json.member("markdown", "**Why it matters.** " + why + "\n\n**What to do.** " + remedy);
  json.end_object();
  json.begin_object("defaultConfiguration", one_line);
  json.member("level", name_of(rule.severity));
  json.end_object();
  json.begin_object("properties", one_line);
  json.begin_array("tags");
  json.value("mesh");
  json.end_array();
  json.member("precision", "very-high");
  json.end_object();
  json.end_object();
}

void write_tool(JsonWriter& json) {
  json.begin_object("tool");
  json.begin_object("driver");
  json.member("name", "fdcg");
  json.member("version", FDCG_VERSION_STRING);
  json.member("semanticVersion", FDCG_VERSION_STRING);
  json.begin_array("rules");
  for (const Rule& rule : rules())
    write_rule(json, rule);
  json.end_array();
  json.end_object();
  json.end_object();
}

class SarifWriter final : public ReportWriter {
 public:
  SarifWriter(Write write, const ReportOptions& options) : write_(std::move(write)), options_(options) {
    json_.begin_object();
    json_.member("$schema", kSchemaUri);
    json_.member("version", "2.1.0");
    json_.begin_array("runs");
    json_.begin_object();
    write_tool(json_);
    json_.begin_object("originalUriBaseIds");
    json_.begin_object(kSarifRoot);
    write_sarif_text(json_, "description", "The folder that fdcg was run in");
    json_.end_object();
    json_.end_object();
    json_.begin_array("results");
  }

  void add(const Report& report) override {
    const std::string uri = file_uri(report.file, options_.source_root);
    write_sarif_results(json_, report, uri, artifacts_.size(), options_);
    artifacts_.push_back(artifact_of(report, uri));
    flush();
  }

  void finish(int exit_code) override {
    json_.end_array();
    json_.begin_array("artifacts");
    for (const std::string& artifact : artifacts_)
      json_.splice(artifact);
    json_.end_array();
    json_.begin_array("invocations");
    json_.begin_object(one_line);
    json_.member("executionSuccessful", exit_code <= 1);
    json_.member("exitCode", exit_code);
    json_.end_object();
    json_.end_array();
    json_.end_object();
    json_.end_array();
    json_.end_object();
    buffer_ += '\n';
    flush();
  }

 private:
  static std::string artifact_of(const Report& report, const std::string& uri) {
    std::string out;
    JsonWriter json(out);
    json.begin_object(one_line);
    json.begin_object("location");
    json.member("uri", uri);
    if (is_relative_uri(uri)) json.member("uriBaseId", kSarifRoot);
    json.end_object();
    json.begin_array("roles");
    json.value("analysisTarget");
    json.end_array();
    json.begin_object("properties");
    json.member("verdict", report.passes() ? "pass" : "fail");
    json.member("vertices", report.vertices);
    json.member("faces", report.faces);
    json.member("kept_faces", report.kept_faces);
    json.member("components", report.components);
    for (const Ignored& ignored : report.ignored)
      json.member("ignored " + ignored.what, ignored.count);
    for (const auto& [rule, total] : report.resolved)
      json.member("resolved " + rule, total);
    if (!report.config.empty()) json.member("config", report.config);
    json.end_object();
    json.end_object();
    return out;
  }
  void flush() {
    write_(buffer_);
    buffer_.clear();
  }

  Write write_;
  ReportOptions options_;
  std::string buffer_;
  JsonWriter json_{buffer_};
  std::vector<std::string> artifacts_;  // in the order of add()
};

}  // namespace

std::unique_ptr<ReportWriter> make_sarif_writer(Write write, const ReportOptions& options) {
  return std::make_unique<SarifWriter>(std::move(write), options);
}

}  // namespace fdcg::bake
