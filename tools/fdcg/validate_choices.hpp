// SPDX-License-Identifier: Apache-2.0
// How validate judges a mesh, as the command line and the rules of a batch say it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "fdcg/bake.hpp"
#include "validate_settings.hpp"

namespace fdcg::tools {

struct ValidateChoices {
  ValidateSettings settings;
  std::optional<bake::Format> input_format;
  bake::Precision precision = bake::Precision::f64;
  bool is_oriented = false;
};

// `choices` must outlive the command's parsing.
void add_validate_verdict(CLI::App& command, ValidateChoices& choices);  // --fail-on, --severity, --allow
void add_validate_checks(CLI::App& command, ValidateChoices& choices);   // --weld, --precision, --orient, --input-format

// By `choices`, with `settings` in place of theirs.
[[nodiscard]] bake::ValidateOptions validate_options(const ValidateChoices& choices, const ValidateSettings& settings);

}  // namespace fdcg::tools
