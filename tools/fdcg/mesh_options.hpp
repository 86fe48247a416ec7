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
void add_mesh_argument(CLI::App& command, std::string& mesh);
// `weld`: a Weld, or an optional one.
template <class Target>
CLI::Option* add_weld_option(const OptionGroup& group, Target& weld, const std::string& shown_default = "exact") {
  return group.parsed(
      "--weld", "DISTANCE", [&weld](const std::string& text) { weld = parse_weld_value(text); },
      offering("Join vertices: exact at equal coordinates, none not at all, a number within that distance in the "
               "file's units.",
               {"exact", "none"}),
      shown_default);
}
void add_input_format_option(CLI::App& command, std::optional<bake::Format>& format);
// --units and --scale. unit_text: for people; unchanged where neither is given.
void add_unit_options(CLI::App& command, double& metres_per_unit, std::string& unit_text);
void add_precision_option(const OptionGroup& group, bake::Precision& precision, const std::string& help);
void add_allow_option(const OptionGroup& group, std::set<std::string>& allow, Allowable allowable);

}  // namespace fdcg::tools
