// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/appearance.hpp
/// How a mesh looks, as its file says, and the heights of its images: those are for the hand (CompileOptions::heights), all
/// else is for the eye alone.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fdcg::bake {

/// Red, green, blue and opacity, 0 to 1, linear.
using Colour = std::array<float, 4>;

/// An image whose brightness is height; one of normals becomes one.
struct HeightImage {
  /// What lies beyond its borders; as fdcg_wrap.
  enum class Wrap : std::uint8_t { repeat, clamp, mirror };

  std::string name;           ///< of its file
  std::uint32_t width = 0;    ///< texels of a row
  std::uint32_t height = 0;   ///< rows
  std::vector<float> values;  ///< row by row from the top, black 0 to white 1; of normals the lowest 0
  double range = 0;           ///< height of white above black in units of the mesh; 0: the file does not say
  std::array<Wrap, 2> wrap = {Wrap::repeat, Wrap::repeat};  ///< along its rows, along its columns
  /// Where texture coordinates (u, v) are on the image, 0 to 1 along each side, the second one downwards:
  /// (p[0] u + p[1] v + p[2], p[3] u + p[4] v + p[5]).
  std::array<double, 6> placing = {1, 0, 0, 0, 1, 0};
};

/// What a material of the mesh file looks like.
struct LookMaterial {
  static constexpr std::uint16_t kNoImage = 0xFFFF;  ///< as `heights`: it has none

  std::string name;                   ///< as in the file; may be empty
  Colour base_colour = {1, 1, 1, 1};  ///< Kd and d of OBJ as they stand, baseColorFactor of glTF
  std::uint16_t heights = kNoImage;   ///< number in Appearance::images
};

/// How the faces of a PolygonSoup look.
struct Appearance {
  static constexpr std::uint16_t kNoMaterial = 0xFFFF;  ///< a face without a material

  std::vector<LookMaterial> materials;       ///< in order of first use
  std::vector<std::uint16_t> face_material;  ///< of each face; empty where there are no materials
  /// Of each entry of PolygonSoup::corners, or empty: texture coordinates, v downwards from the first row of the image, as glTF
  /// has them (those of OBJ, PLY and Draco files are turned). NaN where the file has none at that corner.
  std::vector<std::array<float, 2>> uv;
  /// The same for the images of heights, where they lie by others (texCoord of glTF); empty: by `uv`.
  std::vector<std::array<float, 2>> height_uv;
  std::vector<HeightImage> images;                     ///< of the materials, or one for all faces
  std::uint16_t all_heights = LookMaterial::kNoImage;  ///< the one for all faces, whatever their material
  std::vector<Colour> colours;  ///< of each entry of PolygonSoup::corners, or empty; those of OBJ and PLY are read as sRGB
};

}  // namespace fdcg::bake
