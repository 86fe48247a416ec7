// SPDX-License-Identifier: Apache-2.0
// What compile does with a mesh, as the command line and the rules of a batch say it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "../common/options.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {

inline constexpr const char* kDefaultUnit = "metres (the default)";

struct CompileSettings {
  std::string repair;   // a level; empty: none
  std::string heights;  // ImportOptions::heights
  bool haptic_materials = false;
  std::string unit_text = kDefaultUnit;
  std::optional<bake::Format> input_format;
  bake::CompileOptions options;

  [[nodiscard]] bool has_default_unit() const { return unit_text == kDefaultUnit; }
};

// `settings` must outlive the command's parsing.
void add_compile_input(CLI::App& command, CompileSettings& settings);               // --input-format, --units, --scale
void add_compile_settings(CLI::App& command, CompileSettings& settings);            // checks, graph, mass
void add_shading_options(const OptionGroup& group, bake::CompileOptions& options);  // --normals, --crease
// --heights, --height-range; `heights`: ImportOptions::heights.
void add_heights_options(const OptionGroup& group, bake::CompileOptions& options, std::string& heights);

// Completes settings that were parsed: what is wrong with them, or nothing.
[[nodiscard]] std::string settle(CompileSettings& settings);
// The unit that the file states counts where none was given.
void take_unit(const bake::PolygonSoup& soup, CompileSettings& settings);
// What was asked for may be more than the runtime accepts (a large graph without its hierarchy): better known now than there.
// Why it refuses the file; empty: it does not.
[[nodiscard]] std::string refused_by_runtime(const bake::Compiled& compiled);

}  // namespace fdcg::tools
