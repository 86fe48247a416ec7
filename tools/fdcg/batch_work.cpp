// SPDX-License-Identifier: Apache-2.0
#include "batch_work.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "../common/program.hpp"
#include "../common/terminal.hpp"
#include "fdcg/results.hpp"

namespace fdcg::tools {
namespace {

using Json = nlohmann::ordered_json;

// "3 of non-manifold-edge, 12 of boundary-edge": what fails the mesh.
std::string findings_of(const bake::Report& report) {
  std::string text;
  for (const bake::Issue& issue : report.issues) {
    const bool fails = report.fail_on && issue.severity >= *report.fail_on && report.allowed.count(issue.rule) == 0;
    if (fails) text += (text.empty() ? "" : ", ") + grouped(issue.total) + " of " + issue.rule;
  }
  return text;
}

Json account_json(const bake::RepairAccount& account) {
  Json json{{"found", account.found}, {"actions", Json::array()}};
  for (const bake::RepairAction& action : account.actions) {
    if (action.total != 0 || action.left != 0)
      json["actions"].push_back({{"name", action.name}, {"total", action.total}, {"left", action.left}});
  }
  json["distance"] = account.distance;
  json["volume_before"] = account.volume_before;
  json["volume_after"] = account.volume_after;
  json["faces_before"] = account.faces_before;
  json["faces_after"] = account.faces_after;
  return json;
}

// Members of the result's line, without brackets: the same for each mesh of these bytes.
void fill_body(CacheEntry& entry, const bake::PolygonSoup& soup, const bake::Report& report,
               const bake::RepairAccount* repair) {
  Json json{{"exit_code", entry.exit_code}, {"sha256", soup.sha256}};
  if (entry.has_output) {
    json["output_bytes"] = entry.output.size();
    entry.output_sha256 = bake::sha256_of(entry.output);
    json["output_sha256"] = entry.output_sha256;
  }
  if (repair != nullptr) json["repair"] = account_json(*repair);
  std::string text = json.dump();
  text.pop_back();
  entry.body = text.substr(1) + ",\"report\":" + bake::report_line(report);
}

bake::Result<CacheEntry> work(const ValidateChoices& choices, const bake::PolygonSoup& soup, unsigned jobs) {
  bake::ValidateOptions options = validate_options(choices, choices.settings);
  options.jobs = jobs;
  const bake::Report report = bake::validate(soup, options);
  CacheEntry entry;
  entry.exit_code = report.passes() ? kClean : kFindings;
  entry.said = findings_of(report);
  fill_body(entry, soup, report, nullptr);
  return entry;
}

bake::Result<CacheEntry> work(const CompileSettings& given, const bake::PolygonSoup& soup, unsigned jobs) {
  CompileSettings settings = given;
  settings.options.jobs = jobs;
  take_unit(soup, settings);
  const auto compiled = bake::compile(soup, settings.options);
  if (!compiled) return compiled.error();
  CacheEntry entry;
  entry.has_output = !compiled->file().empty();
  if (entry.has_output) {
    if (const std::string reason = refused_by_runtime(*compiled); !reason.empty()) return bake::Failure{kUsage, reason, {}};
    entry.output.assign(reinterpret_cast<const char*>(compiled->bytes.data()), compiled->bytes.size());
  } else {
    entry.exit_code = kFindings;
    entry.said = findings_of(compiled->report);
  }
  fill_body(entry, soup, compiled->report, compiled->repair ? &*compiled->repair : nullptr);
  return entry;
}

bake::Result<CacheEntry> work(const RepairSettings& given, const bake::PolygonSoup& soup, unsigned jobs) {
  RepairSettings settings = given;
  settings.options.jobs = jobs;
  if (!settings.format) settings.format = written_format(soup.name).value_or(bake::Format::ply);
  suit_format(settings);
  const auto repaired = bake::repair(soup, settings.options);
  if (!repaired) return repaired.error();
  CacheEntry entry;
  auto exported = export_repaired(settings, *repaired, soup.name);
  if (!exported && exported.error().exit_code != kFindings) return exported.error();
  entry.has_output = exported.has_value();
  if (exported) entry.output = std::move(*exported);
  const bool is_clean = exported && repaired->after.passes() && did_all(*repaired);
  entry.exit_code = is_clean ? kClean : kFindings;
  if (!is_clean)
    entry.said = exported ? "left after the repairs: " + findings_of(repaired->after)
                          : exported.error().message.substr(soup.name.size() + 2);  // "NAME: why"
  fill_body(entry, soup, repaired->after, &*repaired);
  return entry;
}

}  // namespace

bake::ImportOptions import_options(const BatchRule& rule) {
  bake::ImportOptions options;
  options.format = std::visit([](const auto& settings) { return settings.input_format; }, rule.settings);
  const auto* const compile = std::get_if<CompileSettings>(&rule.settings);
  if (compile == nullptr) return options;
  options.heights = compile->heights;
  options.haptic_materials = compile->haptic_materials;
  options.appearance = compile->options.visual || compile->options.heights;
  options.normals = compile->options.visual || compile->options.normals == bake::Normals::file;
  return options;
}

bake::Result<CacheEntry> do_batch_work(const BatchRule& rule, const bake::PolygonSoup& soup, unsigned jobs) {
  return std::visit([&](const auto& settings) { return work(settings, soup, jobs); }, rule.settings);
}

}  // namespace fdcg::tools
