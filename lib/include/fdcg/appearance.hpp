// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/appearance.hpp
/// How a mesh looks, as its file says: for the eye alone, the hand feels nothing of it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fdcg::bake {

/// Red, green, blue and opacity, 0 to 1, linear.
using Colour = std::array<float, 4>;

/// What a material of the mesh file looks like.
struct LookMaterial {
  std::string name;                   ///< as in the file; may be empty
  Colour base_colour = {1, 1, 1, 1};  ///< Kd and d of OBJ as they stand, baseColorFactor of glTF
};

/// How the faces of a PolygonSoup look.
struct Appearance {
  static constexpr std::uint16_t kNoMaterial = 0xFFFF;  ///< a face without a material

  std::vector<LookMaterial> materials;       ///< in order of first use
  std::vector<std::uint16_t> face_material;  ///< of each face; empty where there are no materials
  /// Of each entry of PolygonSoup::corners, or empty: texture coordinates, v downwards from the first row of the image, as glTF
  /// has them (those of OBJ and PLY are turned). NaN where the file has none at that corner.
  std::vector<std::array<float, 2>> uv;
  std::vector<Colour> colours;  ///< of each entry of PolygonSoup::corners, or empty; those of OBJ and PLY are read as sRGB
};

}  // namespace fdcg::bake
