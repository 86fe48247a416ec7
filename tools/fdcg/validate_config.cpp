// SPDX-License-Identifier: Apache-2.0
#include "validate_config.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "../common/nearest.hpp"
#include "../common/one_line.hpp"
#include "fdcg_commands.hpp"
#include "json_words.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::vector<std::string> kKeys{"$schema", "allow", "baseline", "fail-on", "severity", "weld"};

// One line of what went wrong; empty: nothing.
using Complaint = std::string;

Complaint must_be(const std::string& key, const std::string& what, const Json& value) {
  // Printing a value within a hundred thousand others would take as many calls within each other.
  const std::string found = value.is_structured() ? "an " + std::string(value.type_name())
                                                  : value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 60);
  return "'" + key + "' must be " + what + ", not " + found;
}

Complaint read_allow(const Json& value, ValidateSettings& settings) {
  if (!value.is_array()) return must_be("allow", "a list of rules", value);
  for (const Json& rule : value) {
    if (!rule.is_string()) return must_be("allow", "a list of rules", value);
    if (const auto failure = check_allowed_rule(rule.get<std::string>())) return "'allow': " + failure->message;
    settings.allow.insert(rule.get<std::string>());
  }
  return {};
}

Complaint read_severities(const Json& value, ValidateSettings& settings) {
  const char* const kWhat = "an object of rules and error, warning, note or off";
  if (!value.is_object()) return must_be("severity", kWhat, value);
  for (const auto& [rule, level] : value.items()) {
    if (!level.is_string()) return must_be("severity", kWhat, value);
    const auto severity = parse_severity(rule, level.get<std::string>());
    if (!severity) return "'severity': " + severity.error().message;
    settings.severities[rule] = *severity;
  }
  return {};
}

Complaint read_weld(const Json& value, ValidateSettings& settings) {
  using Kind = bake::Weld::Kind;
  if (value == "exact" || value == "none") {
    settings.weld = {value == "exact" ? Kind::exact : Kind::none, 0};
    return {};
  }
  if (!value.is_number() || !(value.get<double>() > 0))
    return must_be("weld", "\"exact\", \"none\" or a number above 0", value);
  settings.weld = {Kind::distance, value.get<double>()};
  return {};
}

Complaint read_key(const std::string& key, const Json& value, const fs::path& folder, ValidateSettings& settings) {
  if (key == "$schema") return {};
  if (key == "allow") return read_allow(value, settings);
  if (key == "severity") return read_severities(value, settings);
  if (key == "weld") return read_weld(value, settings);
  if (key == "fail-on") {
    if (!value.is_string()) return must_be(key, "error, warning, note or never", value);
    const auto level = parse_fail_on(value.get<std::string>());
    if (!level) return "'fail-on': " + level.error().message;
    settings.fail_on = *level;
    return {};
  }
  if (key == "baseline") {
    if (!value.is_string() || value.get<std::string>().empty()) return must_be(key, "the path of a report", value);
    settings.baseline = (folder / value.get<std::string>()).lexically_normal().string();
    return {};
  }
  std::string known;
  for (const std::string& k : kKeys)
    known += (known.empty() ? "" : ", ") + k;
  return "'" + key + "' is no key" + did_you_mean(key, kKeys) + " (the keys are " + known + ")";
}

}  // namespace

bake::Result<ValidateConfig> read_config(const std::string& path) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(path, ignored);  // which opens like a file, but throws when it is read
  std::ifstream file;
  if (!is_folder) file.open(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (!file.is_open() || file.bad()) {
    const std::string why = is_folder                    ? "is a directory; name a file of settings"
                            : !fs::exists(path, ignored) ? "does not exist; check the path"
                                                         : "cannot be read; check its permissions";
    return bake::Failure{kFile, one_line(path + ": " + why + ", or pass --no-config"), {}};
  }
  ValidateConfig config{path, {}};
  DuplicateKeys duplicates;
  try {
    const Json json = Json::parse(text, std::ref(duplicates));
    Complaint complaint;
    if (!json.is_object()) complaint = "holds no JSON object; write { \"fail-on\": \"warning\" }, say";
    if (!duplicates.duplicate.empty()) complaint = "'" + duplicates.duplicate + "' stands twice; keep one";
    if (json.is_object()) {
      for (const auto& [key, value] : json.items()) {
        if (complaint.empty()) complaint = read_key(key, value, fs::path(path).parent_path(), config.settings);
      }
    }
    if (!complaint.empty()) return bake::Failure{kUsage, one_line(path + ": " + complaint), {}};
  } catch (const Json::exception& error) {
    return bake::Failure{kUsage, one_line(path + ": is no JSON: " + plain_complaint(error)), {}};
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
