// SPDX-License-Identifier: Apache-2.0
// Images of normals (normalTexture of glTF) as images of heights.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// What is stated of an image of normals, and how large it is on the mesh.
struct NormalImage {
  double scale = 1;                           // of the slopes
  std::array<double, 2> image_size = {1, 1};  // along its rows, along its columns: in units of the mesh, above 0
};

// Sets size, values and range of `image`, whose wrap and name are there, from the bytes of a PNG in colour: x to the right, y
// upwards, z out of the surface, 0 to 1 for -1 to 1. The lowest height is 0, the highest 1, and `range` is between them in
// units of the mesh; 0 where all normals are upright. A number within half a step of the image's numbers from 0 counts as 0,
// so that what is flat is flat; a normal that leans by more than 84 degrees, or inward, counts as one that leans so. What is
// wrong; none: nothing.
[[nodiscard]] std::optional<Failure> read_normal_image(std::string_view png, const NormalImage& how, HeightImage& image);

}  // namespace fdcg::bake
