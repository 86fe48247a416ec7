// SPDX-License-Identifier: Apache-2.0
#include "validate_settings.hpp"

#include <vector>

#include "fdcg_commands.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

bake::Failure wrong(const std::string& message) {
  return {kUsage, message, {}};
}

Level level_of(const std::string& name) {
  if (name == "note") return bake::Severity::note;
  if (name == "warning") return bake::Severity::warning;
  if (name == "error") return bake::Severity::error;
  return std::nullopt;
}

std::vector<std::string> rule_names() {
  std::vector<std::string> names;
  for (const bake::Rule& rule : bake::rules())
    names.emplace_back(rule.name);
  return names;
}

bake::Failure no_rule(const std::string& name) {
  return wrong("'" + name + "' is no rule" + did_you_mean(name, rule_names()) + " ('fdcg explain' lists them)");
}

// Exit code 3 stands for these two whatever is asked for.
bool is_about_the_file(const std::string& rule) {
  return rule == "unreadable" || rule == "empty-mesh";
}

}  // namespace

ValidateSettings combined(const ValidateSettings& weaker, const ValidateSettings& stronger) {
  ValidateSettings result = stronger;
  if (!result.weld) result.weld = weaker.weld;
  if (!result.fail_on) result.fail_on = weaker.fail_on;
  if (!result.baseline) result.baseline = weaker.baseline;
  result.allow.insert(weaker.allow.begin(), weaker.allow.end());
  result.severities.insert(weaker.severities.begin(), weaker.severities.end());
  return result;
}

bake::Result<Level> parse_fail_on(const std::string& text) {
  const std::vector<std::string> choices{"error", "warning", "note", "never"};
  if (text == "never" || level_of(text)) return level_of(text);
  return wrong("'" + text + "' is none of error, warning, note, never" + did_you_mean(text, choices));
}

bake::Result<Level> parse_severity(const std::string& rule, const std::string& text) {
  if (bake::find_rule(rule) == nullptr) return no_rule(rule);
  if (is_about_the_file(rule)) return wrong("'" + rule + "' is always an error: such a file gives exit code 3");
  if (text == "off" || level_of(text)) return level_of(text);
  return wrong("'" + text + "' is none of error, warning, note, off" + did_you_mean(text, {"error", "warning", "note", "off"}));
}

std::string lowered_errors(const ValidateSettings& settings) {
  std::vector<std::string> names;
  for (const auto& [name, level] : settings.severities) {
    const bake::Rule* const rule = bake::find_rule(name);
    const bool is_lowered = !level || *level < bake::Severity::error;
    if (rule != nullptr && is_lowered && rule->severity == bake::Severity::error && !rule->can_be_allowed)
      names.push_back(name);
  }
  if (names.empty()) return {};
  return listed(names) + (names.size() == 1 ? " is" : " are") +
         " no error here by its severity; 'fdcg compile' refuses meshes with it all the same";
}

std::optional<bake::Failure> check_allowed_rule(const std::string& name) {
  const bake::Rule* const rule = bake::find_rule(name);
  if (rule == nullptr) return no_rule(name);
  if (rule->severity != bake::Severity::error || rule->can_be_allowed) return std::nullopt;
  std::string choices;
  for (const bake::Rule& known : bake::rules()) {
    if (known.severity != bake::Severity::error || known.can_be_allowed)
      choices += (choices.empty() ? "" : ", ") + std::string(known.name);
  }
  return wrong("'" + name + "' cannot be allowed: no graph can stand it; these can: " + choices);
}

}  // namespace fdcg::tools
