// SPDX-License-Identifier: Apache-2.0
// The meshes that the arguments of a command name: files, those in folders, and those of robots.
#pragma once

#include <string>
#include <vector>

#include "../common/expand_paths.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {

struct ListedMesh : NamedFile {
  bake::Vec3 scale{1, 1, 1};  // of a robot's description
  std::string robot;          // the description that names it; empty: none
};

struct MeshList {
  std::vector<ListedMesh> meshes;
  std::vector<std::string> notes;  // for people, one line each: which files of a folder were skipped, what a robot names
};

// Each argument in its turn, as expand_paths has it; a description of a robot gives the meshes that it names.
MeshList list_meshes(const std::vector<std::string>& arguments);

}  // namespace fdcg::tools
