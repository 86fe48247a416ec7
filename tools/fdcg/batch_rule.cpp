// SPDX-License-Identifier: Apache-2.0
#include "batch_rule.hpp"

#include <algorithm>
#include <utility>

#include "../common/expand_paths.hpp"
#include "../common/program.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

bake::Failure wrong_rule(const std::string& message) {
  return {kUsage, message, {}};
}

void declare(CLI::App& app, ValidateChoices& choices) {
  add_validate_verdict(app, choices);
  add_validate_checks(app, choices);
}
void declare(CLI::App& app, RepairSettings& settings) {
  add_repair_settings(app, settings);
}
void declare(CLI::App& app, CompileSettings& settings) {
  add_compile_input(app, settings);
  add_compile_settings(app, settings);
}

std::string settle(const ValidateChoices&) {
  return {};
}

// What is wrong with the options, or nothing.
template <class Settings>
std::string read_options(const std::vector<std::string>& options, Settings& settings) {
  CLI::App app;
  app.set_help_flag();
  declare(app, settings);
  std::vector<std::string> reversed(options.rbegin(), options.rend());  // as CLI11 wants them
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    return complaint(error, app, app);
  }
  return settle(settings);
}

std::string read_options(BatchRule& rule) {
  if (rule.action == "compile") rule.settings.emplace<CompileSettings>();
  if (rule.action == "repair") rule.settings.emplace<RepairSettings>();
  return std::visit([&](auto& settings) { return read_options(rule.options, settings); }, rule.settings);
}

const char* ending_of(bake::Format format) {
  using enum bake::Format;
  return format == off ? ".off" : format == obj ? ".obj" : format == stl ? ".stl" : ".ply";
}

}  // namespace

bool BatchRule::takes(const std::string& mesh) const {
  return match.empty() || matches_path(mesh, match);
}

std::string BatchRule::output_of(const std::string& mesh) const {
  if (action == "compile") return mesh + ".fdcg";
  if (action == "validate") return {};
  const std::optional<bake::Format> own = written_format(mesh), format = std::get<RepairSettings>(settings).format;
  if (own && (!format || *format == *own)) return mesh;
  return mesh + ending_of(format.value_or(bake::Format::ply));
}

bake::Result<BatchRule> make_batch_rule(std::string match, std::string action, std::vector<std::string> options) {
  const std::vector<std::string> actions{"validate", "repair", "compile"};
  if (std::find(actions.begin(), actions.end(), action) == actions.end())
    return wrong_rule("'" + action + "' is no action; there are " + listed(actions) + did_you_mean(action, actions));
  BatchRule rule{std::move(match), std::move(action), std::move(options), {}};
  if (const std::string complaint = read_options(rule); !complaint.empty()) return wrong_rule(rule.action + ": " + complaint);
  return rule;
}

}  // namespace fdcg::tools
