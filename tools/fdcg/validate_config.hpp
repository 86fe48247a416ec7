// SPDX-License-Identifier: Apache-2.0
// .fdcg-validate.json: settings that stand beside the meshes. schemas/validate-config.schema.json describes it.
#pragma once

#include <map>
#include <string>

#include "fdcg/bake.hpp"
#include "validate_settings.hpp"

namespace fdcg::tools {

inline constexpr const char* kConfigName = ".fdcg-validate.json";

struct ValidateConfig {
  std::string path;  // empty: there is none, and `settings` say nothing
  ValidateSettings settings;
};

// Fails (3) where the file cannot be read, (2) where it is no JSON, has an unknown key or a wrong value; the message names
// file, key and what is right. Relative paths in it start from its folder.
bake::Result<ValidateConfig> read_config(const std::string& path);

// Finds for each mesh the nearest file of that name, from the mesh's own folder upwards ("-": from the current folder); reads
// each once.
class ConfigFinder {
 public:
  bake::Result<ValidateConfig> for_mesh(const std::string& mesh);

 private:
  bake::Result<ValidateConfig> for_folder(const std::string& folder);

  std::map<std::string, bake::Result<ValidateConfig>> by_folder_;  // absolute; read or inherited
};

}  // namespace fdcg::tools
