// SPDX-License-Identifier: Apache-2.0
// Divides and smooths the triangles that close a hole.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

struct FairPatch {
  std::vector<Vec3> points;  // new ones
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// Divides the triangles of an outline to the length of its edges (Liepa 2003, "Filling holes in meshes"), and moves the new
// points to a surface of little bending (second-order umbrella; Kobbelt et al. 1998). `beyond`: for each corner of the outline
// a point of the surface around, as far from it as its edges are long, to which the patch goes on smoothly. At most some
// thousand new points: a large patch stays coarser.
[[nodiscard]] FairPatch fair_patch(std::span<const Vec3> outline, std::span<const Vec3> beyond,
                                   std::vector<std::array<std::uint32_t, 3>> triangles);

}  // namespace fdcg::bake
