// SPDX-License-Identifier: Apache-2.0
// Images of heights: read from their files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// ImportOptions::heights of those that the mesh file names.
inline constexpr std::string_view kHeightsOfFile = "file";

// Sets size and values of an image from the bytes of a PNG; of colours their mean. What is wrong; none: nothing.
[[nodiscard]] std::optional<Failure> read_height_image(std::string_view png, HeightImage& image);

// The same from the file image.name, in or beneath the folder of the mesh file that names it; the path is added to `files`.
[[nodiscard]] std::optional<Failure> read_height_image_beside(const std::filesystem::path& mesh, HeightImage& image,
                                                              std::vector<std::string>& files);

// One image for all faces, from a path that the user gave.
[[nodiscard]] std::optional<Failure> add_heights_for_all(const std::string& path, PolygonSoup& soup);

}  // namespace fdcg::bake
