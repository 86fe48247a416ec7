// SPDX-License-Identifier: Apache-2.0
// Triangles that close a hole.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

struct HolePatch {
  bool is_flat = false;                                 // the hole lies in a plane, but for rounding
  std::vector<Vec3> points;                             // new ones, inside the patch
  std::vector<std::array<std::uint32_t, 3>> triangles;  // corners of the outline, then new points
};

// Closes an outline, which the triangles run along. One that lies in a plane gets the triangles of that plane; any other those
// of least area, or of short diagonals where it has very many corners, divided to the size of the outline's edges and smoothed
// to a surface of little bending that goes on from the faces around. The patch may pass through other faces. `normals`: of the
// face at each edge of the outline, of any length. `is_barred(i, j)`: a diagonal that should not be taken.
[[nodiscard]] HolePatch patch_hole(std::span<const Vec3> outline, std::span<const Vec3> normals,
                                   const std::function<bool(std::uint32_t, std::uint32_t)>& is_barred);

}  // namespace fdcg::bake
