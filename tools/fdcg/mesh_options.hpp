// SPDX-License-Identifier: Apache-2.0
// Values that compile and validate read alike. A wrong one throws CLI::ValidationError, which names the right ones.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../common/options.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {

enum class Allowable { errors_the_graph_stands, also_warnings_and_notes };

bake::Weld parse_weld_value(const std::string& text);
void add_weld_option(CLI::App& command, bake::Weld& weld);
void add_weld_option(CLI::App& command, std::optional<bake::Weld>& weld);
void add_input_format_option(CLI::App& command, std::optional<bake::Format>& format);
// --units and --scale. unit_text: for people; unchanged where neither is given.
void add_unit_options(CLI::App& command, double& metres_per_unit, std::string& unit_text);
void add_precision_option(CLI::App& command, bake::Precision& precision, const std::string& help, const std::string& group);
void add_allow_option(CLI::App& command, std::set<std::string>& allow, Allowable allowable);

// Of the files that are meshes by their names, in lower case: ".off" and so on.
const std::vector<std::string>& mesh_endings();

}  // namespace fdcg::tools
