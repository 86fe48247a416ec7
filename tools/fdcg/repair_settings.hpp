// SPDX-License-Identifier: Apache-2.0
// What repair does with a mesh, as the command line and the rules of a batch say it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

struct RepairSettings {
  std::optional<bake::Format> format, input_format;
  std::optional<bake::Weld> weld;
  bake::RepairOptions options;
  bool all = false;
  std::string solid;  // how; empty: not asked for
  std::optional<bake::Extent> hole_size, voxel;
  bool ascii = false;
  bool strict = false;
};

// `settings` must outlive the command's parsing.
void add_repair_settings(CLI::App& command, RepairSettings& settings);

// Completes settings that were parsed: what is wrong with them, or nothing.
[[nodiscard]] std::string settle(RepairSettings& settings);
// Of the formats that can be written the one that a file's name ends in.
[[nodiscard]] std::optional<bake::Format> written_format(const std::string& path);
// For a result in `format`, which must be set.
void suit_format(RepairSettings& settings);

// The bytes of the repaired mesh, or why they are not to be written (1) or cannot be (2); `output` is for messages.
[[nodiscard]] bake::Result<std::string> export_repaired(const RepairSettings& settings, const bake::Repaired& repaired,
                                                        const std::string& output);
// simplify and solid are done, or were not asked for.
[[nodiscard]] bool did_all(const bake::Repaired& repaired);

}  // namespace fdcg::tools
