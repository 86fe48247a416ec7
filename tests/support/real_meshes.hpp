// SPDX-License-Identifier: Apache-2.0
// Real meshes, if available: the folder in FDCG_REAL_MESHES, else ../shared/meshes beside the project, and the data of Debian's
// libcgal-dev if it was unpacked into such a folder. Tests pass without them and report how many they found.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

inline std::vector<bake::PolygonSoup> real_meshes() {
  constexpr std::uintmax_t kLargest = 6u << 20;  // bytes: exact arithmetic on every edge takes its time
  const char* named = std::getenv("FDCG_REAL_MESHES");
  const std::filesystem::path folder =
      named != nullptr ? std::filesystem::path(named) : std::filesystem::path(FDCG_SOURCE_DIR) / "../shared/meshes";
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file() && entry.file_size() <= kLargest) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<bake::PolygonSoup> soups;
  for (const auto& file : files) {
    auto soup = bake::import_mesh(file);
    if (soup.has_value()) soups.push_back(std::move(*soup));
  }
  return soups;
}

}  // namespace fdcg::test
