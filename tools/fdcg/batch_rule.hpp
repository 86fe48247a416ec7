// SPDX-License-Identifier: Apache-2.0
// A rule of a batch: which meshes, which command, and that command's own options.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "compile_settings.hpp"
#include "fdcg/bake.hpp"
#include "repair_settings.hpp"
#include "validate_choices.hpp"

namespace fdcg::tools {

struct BatchRule {
  std::string match;   // as matches_path has it; empty: every mesh
  std::string action;  // validate, repair or compile
  std::vector<std::string> options;
  std::variant<ValidateChoices, RepairSettings, CompileSettings> settings;

  [[nodiscard]] bool takes(const std::string& mesh) const;
  // Of what it writes for a mesh: "parts/a.stl.fdcg"; empty where it writes nothing.
  [[nodiscard]] std::string output_of(const std::string& mesh) const;
};

// Reads the options with the tables of the command. Fails (2) on an action or an option that there is not.
bake::Result<BatchRule> make_batch_rule(std::string match, std::string action, std::vector<std::string> options);

}  // namespace fdcg::tools
