// SPDX-License-Identifier: Apache-2.0
// Third-party mesh files, if available: the folder in FDCG_REAL_MESHES, else ../shared/meshes beside the project; Debian's
// assimp-testmodels; the data of its libcgal-demo as unpacked by the build. A test without any counts as skipped.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "catch.hpp"

namespace fdcg::test {

inline std::vector<std::filesystem::path> real_mesh_files() {
  const char* named = std::getenv("FDCG_REAL_MESHES");
  const std::vector<std::filesystem::path> folders = {
      named != nullptr ? std::filesystem::path(named) : std::filesystem::path(FDCG_SOURCE_DIR) / "../shared/meshes",
      "/usr/share/assimp/models", FDCG_CGAL_DATA};
  std::vector<std::filesystem::path> files;
  for (const auto& folder : folders) {
    std::error_code error;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
      std::string ending = entry.path().extension().string();
      std::transform(ending.begin(), ending.end(), ending.begin(),
                     [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
      constexpr const char* kEndings[] = {".off", ".obj", ".ply", ".stl", ".gltf", ".glb", ".drc"};
      const bool is_mesh = std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings);
      if (is_mesh && entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  if (files.empty()) WARN("skipped: no mesh files at hand");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace fdcg::test
