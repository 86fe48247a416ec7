// SPDX-License-Identifier: Apache-2.0
// Vertices around which no two faces can meet: found once a vertex, so that pairs of neighbours need no test.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"

namespace fdcg::bake {

struct SimpleStars {
  // Of each vertex 1 where any two of its triangles certainly have no point in common but their shared vertices and sides: its
  // faces close up around it, and some direction sees each from its front, and once. 0: undecided.
  std::vector<std::uint8_t> is_simple;
  std::uint32_t most_faces = 0;  // of any vertex
};

// Triangles only; corners are finite or on faces that the topology skips. Linear: some 70 ns a vertex, on `jobs` threads.
[[nodiscard]] SimpleStars find_simple_stars(const Mesh& mesh, const Topology& topology, unsigned jobs);

}  // namespace fdcg::bake
