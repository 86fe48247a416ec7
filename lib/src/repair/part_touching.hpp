// SPDX-License-Identifier: Apache-2.0
// Moves solids that touch in an edge or a vertex apart.
#pragma once

#include <cstdint>

#include "repair/repair.hpp"

namespace fdcg::bake {

struct Parting {
  std::uint64_t moved = 0;  // vertices
  std::uint64_t left = 0;   // pairs of faces that still meet
  double distance = 0;      // of the farthest move
};

// The faces become triangles. Vertices at equal coordinates, which cut_edges() and split_vertices_step() have put apart, are
// moved into the solids that they belong to, by at most `reach`, or less where that would make faces meet. Each belongs to one
// fan of a closed surface that does not pass through itself.
// `first_made`: points from it on are those that the two made.
[[nodiscard]] Parting part_touching(Workpiece& piece, std::uint32_t first_made, double reach, bool as_floats, unsigned jobs);

}  // namespace fdcg::bake
