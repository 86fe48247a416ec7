// SPDX-License-Identifier: Apache-2.0
#include "validate_config.hpp"

#include <filesystem>

#include "fdcg_commands.hpp"
#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;

using json::Value;

constexpr int kMostRules = 1000;
constexpr std::size_t kLongestPath = 4000;
constexpr json::Keys kKeys{"$schema", "allow", "baseline", "fail-on", "severity", "weld"};

void read_allow(const Value& allow, ValidateSettings& settings) {
  for (const Value& rule : allow.items(0, kMostRules, "rules")) {
    if (const auto failure = check_allowed_rule(rule.string())) rule.fail(": " + failure->message);
    settings.allow.insert(rule.string());
  }
}

void read_severities(const Value& severities, ValidateSettings& settings) {
  for (const std::string& rule : severities.keys()) {
    const Value level = severities[rule];
    const auto severity = parse_severity(rule, level.string());
    if (!severity) level.fail(": " + severity.error().message);
    settings.severities[rule] = *severity;
  }
}

bake::Weld weld_of(const Value& value) {
  using Kind = bake::Weld::Kind;
  if (value.is_string() && value.string() == "exact") return {Kind::exact, 0};
  if (value.is_string() && value.string() == "none") return {Kind::none, 0};
  const double distance = value.is_number() ? value.number() : 0;
  if (!(distance > 0)) value.must_be("\"exact\", \"none\" or a number above 0");
  return {Kind::distance, distance};
}

void read_settings(const Value& config, const fs::path& folder, ValidateSettings& settings) {
  if (const Value allow = config["allow"]) read_allow(allow, settings);
  if (const Value severities = config["severity"]) read_severities(severities, settings);
  if (const Value weld = config["weld"]) settings.weld = weld_of(weld);
  if (const Value baseline = config["baseline"])
    settings.baseline = (folder / baseline.text(kLongestPath)).lexically_normal().string();
  const Value fail_on = config["fail-on"];
  if (!fail_on) return;
  const auto level = parse_fail_on(fail_on.string());
  if (!level) fail_on.fail(": " + level.error().message);
  settings.fail_on = *level;
}

}  // namespace

bake::Result<ValidateConfig> read_config(const std::string& path) {
  std::string text;
  if (const std::string trouble = json::read_text_file(path, json::Limits{}.bytes, &text); !trouble.empty())
    return bake::Failure{kFile, trouble + ", or pass --no-config", {}};
  ValidateConfig config{path, {}};
  try {
    const json::Document document(text);
    read_settings(document.object(kKeys), fs::path(path).parent_path(), config.settings);
  } catch (const json::Refusal& refusal) {
    return bake::Failure{kUsage, one_line(path + ": " + refusal.message), {}};
  }
  return config;
}

bake::Result<ValidateConfig> ConfigFinder::for_folder(const std::string& folder) {
  if (const auto known = by_folder_.find(folder); known != by_folder_.end()) return known->second;
  const fs::path candidate = fs::path(folder) / kConfigName;
  const std::string above = fs::path(folder).parent_path().string();
  std::error_code ignored;
  bake::Result<ValidateConfig> config = ValidateConfig{};
  if (fs::exists(candidate, ignored)) {
    // As a person would name it: seen from the current folder where it lies below it.
    const fs::path near = candidate.lexically_relative(fs::current_path(ignored));
    const bool is_below = !near.empty() && *near.begin() != "..";
    config = read_config(is_below ? near.string() : candidate.string());
  } else if (above != folder) {
    config = for_folder(above);
  }
  by_folder_.emplace(folder, config);
  return config;
}

bake::Result<ValidateConfig> ConfigFinder::for_mesh(const std::string& mesh) {
  std::error_code error;
  fs::path folder = mesh == "-" ? fs::current_path(error) : fs::absolute(mesh, error).lexically_normal().parent_path();
  if (error) return ValidateConfig{};  // no current folder: none is upwards of it
  if (folder.empty()) folder = "/";
  return for_folder(folder.string());
}

}  // namespace fdcg::tools
