// SPDX-License-Identifier: Apache-2.0
// Real meshes, if available: the folder in FDCG_REAL_MESHES, else ../shared/meshes beside the project, else the small ones of
// Debian's libcgal-demo as unpacked by the build (FDCG_CGAL_DATA). A test without any counts as skipped.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "catch.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::test {

inline std::vector<bake::PolygonSoup> real_meshes() {
  const char* named = std::getenv("FDCG_REAL_MESHES");
  std::filesystem::path folder =
      named != nullptr ? std::filesystem::path(named) : std::filesystem::path(FDCG_SOURCE_DIR) / "../shared/meshes";
  std::uintmax_t largest = 6u << 20;  // bytes: exact arithmetic on every edge takes its time
  if (!std::filesystem::exists(folder)) {
    folder = FDCG_CGAL_DATA;
    largest = 200'000;
  }
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file() && entry.file_size() <= largest) files.push_back(entry.path());
  }
  if (files.empty()) WARN("skipped: no real meshes at hand");
  std::sort(files.begin(), files.end());
  std::vector<bake::PolygonSoup> soups;
  for (const auto& file : files) {
    auto soup = bake::import_mesh(file);
    if (soup.has_value()) soups.push_back(std::move(*soup));
  }
  return soups;
}

}  // namespace fdcg::test
