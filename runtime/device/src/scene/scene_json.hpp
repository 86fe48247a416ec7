// SPDX-License-Identifier: Apache-2.0
// Scenes as JSON, by schemas/servo-scene.schema.json. Load time only; allocates.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/host_config.hpp"

namespace fdcg::dev {

struct SceneOptions {
  bool reads_files = true;  // profiles and recordings that the scene names; false (fuzzing): a name of a file is an error
  bool shares_soft = true;  // false (logs of the time before "shared"): each device has soft objects of its own
};

// Empty: *config is the whole of it. Otherwise one line that names file_name, the field, what was found and what is expected;
// *config is then not to be used. Files are named from file_name's folder and are given in full. `warnings` (may be null) gets
// a line for each setting that works but may surprise, such as a device without force.
std::string parse_scene(std::string_view text, const std::string& file_name, HostConfig* config,
                        std::vector<std::string>* warnings = nullptr, const SceneOptions& options = {});
// The same for a file.
std::string read_scene(const std::string& path, HostConfig* config, std::vector<std::string>* warnings = nullptr);

// A scene that parse_scene reads back as the same objects and devices bit for bit, whatever defaults it will have: every
// number written out, profiles in place, files as `config` names them. One line. What a log starts with.
std::string write_scene(const HostConfig& config);

// Which device of a recording a scene's device of that name plays: the one of the same name, or the only one. The number of
// devices where there is none.
std::size_t find_recorded_device(const HostConfig& recorded, const std::string& name);

}  // namespace fdcg::dev
