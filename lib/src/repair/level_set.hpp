// SPDX-License-Identifier: Apache-2.0
// Rebuilds a surface from the generalised winding number of triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "repair/surface_distance.hpp"
#include "solid/facets.hpp"

namespace fdcg::bake {

struct LevelSet {
  enum class Outcome : std::uint8_t { done, too_fine, nothing_enclosed };
  Outcome outcome = Outcome::done;
  FacetSet set;  // closed, without intersections; sources are triangles of the input
};

// The most places that are looked at; their number goes with the square of the size over the voxel.
inline constexpr std::size_t kMostLatticePoints = 20'000'000;

// The boundary of where the winding number is above one half, on a lattice of cubes of side `voxel`, each divided into six
// tetrahedra. Near the triangles it is where they are, to the second order; across a hole it is where the winding number says;
// features smaller than the voxel are lost, sharp edges are blunted by less than it. Closed, manifold, and free of
// intersections by construction. Some microseconds a lattice point at the surface.
[[nodiscard]] LevelSet level_set_surface(const TriangleSet& triangles, double voxel, unsigned jobs, const Progress& progress);

}  // namespace fdcg::bake
