// SPDX-License-Identifier: Apache-2.0
// Files that a mesh file names: only those in or beneath its folder are read.
#pragma once

#include <filesystem>
#include <string>

namespace fdcg::bake {

// A relative path that stays in the folder: no scheme ("http:", "C:"), no root, no "..".
[[nodiscard]] bool stays_beneath(const std::filesystem::path& path, const std::string& text);

// With links followed.
[[nodiscard]] bool lies_beneath(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace fdcg::bake
