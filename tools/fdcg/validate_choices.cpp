// SPDX-License-Identifier: Apache-2.0
#include "validate_choices.hpp"

#include "../common/options.hpp"
#include "mesh_options.hpp"

namespace fdcg::tools {

void add_validate_verdict(CLI::App& command, ValidateChoices& choices) {
  const OptionGroup verdict(command, "Verdict");
  ValidateSettings& settings = choices.settings;
  const auto set_fail_on = [&settings](const std::string& value) {
    const auto level = parse_fail_on(value);
    if (!level) throw CLI::ValidationError("--fail-on", level.error().message);
    settings.fail_on = *level;
  };
  verdict.parsed(
      "--fail-on", "SEVERITY", set_fail_on,
      one_of("Exit with code 1 for findings of this severity or a higher one.", {"error", "warning", "note", "never"}),
      "error");
  const auto set_severity = [&settings](const std::string& value) {
    const std::size_t equals = value.find('=');
    if (equals == std::string::npos)
      throw CLI::ValidationError("--severity", "'" + value + "' is no RULE=LEVEL; write boundary-edge=error, say");
    const std::string rule = value.substr(0, equals);
    const auto level = parse_severity(rule, value.substr(equals + 1));
    if (!level) throw CLI::ValidationError("--severity", level.error().message);
    settings.severities[rule] = *level;
  };
  verdict.repeated("--severity", "RULE=LEVEL", set_severity,
                   "Severity of the findings of a rule: error, warning, note or off. May be repeated.");
  add_allow_option(OptionGroup(command, "Mesh checks"), settings.allow, Allowable::also_warnings_and_notes);
}

void add_validate_checks(CLI::App& command, ValidateChoices& choices) {
  const OptionGroup checks(command, "Mesh checks");
  add_weld_option(checks, choices.settings.weld);
  add_precision_option(checks, choices.precision, "Check the mesh as a graph of this precision stores it.");
  checks.flag("--orient", choices.is_oriented, "Check the mesh as 'fdcg compile --orient' leaves it.");
  add_input_format_option(command, choices.input_format);
}

bake::ValidateOptions validate_options(const ValidateChoices& choices, const ValidateSettings& settings) {
  bake::ValidateOptions options;
  options.weld = settings.weld.value_or(bake::Weld{});
  options.precision = choices.precision;
  options.orient = choices.is_oriented;
  options.allow = settings.allow;
  options.severities = settings.severities;
  if (settings.fail_on) options.fail_on = *settings.fail_on;
  return options;
}

}  // namespace fdcg::tools
