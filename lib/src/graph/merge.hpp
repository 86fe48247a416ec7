// SPDX-License-Identifier: Apache-2.0
// Planar regions -> few convex polygons.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "graph/classify.hpp"
#include "graph/regions.hpp"

namespace fdcg::bake {

inline constexpr std::uint32_t kMaxMergedSides = 16;  // of a merged polygon, so that a step at a face is bounded

struct MergeOptions {
  bool across_faces = true;  // false: only triangles that were cut from the same polygon are merged
  Coplanar coplanar;
  Quantum quantum;
  const std::vector<std::uint32_t>* polygon = nullptr;  // of each triangle: the polygon it was cut from; null: none was cut
  unsigned jobs = 1;
};

struct Merged {
  Mesh mesh;  // convex polygons
  Topology topology;
  std::vector<EdgeClass> edges;
  Regions regions;
  std::vector<std::uint32_t> face_of_triangle;  // of each triangle given: the polygon where its centre now lies; empty: itself
  double removed_distance = 0;  // the largest of a vertex that was removed between collinear edges from the edge in their place
};

// For each region, exactly, in its projection along one axis:
//   1. removes vertices inside the region, and vertices between two collinear edges of the same two regions (or of one region
//   and
//      the open boundary), in both regions at once, and triangulates the holes. Collinear means exactly or, unless `coplanar`
//      is exact, that every vertex already removed from the edge is within kQuantumReach times the largest quantum of that
//      vertex and the ends;
//   2. drops diagonals, longest first, while the polygon stays convex and has at most kMaxMergedSides sides (Hertel and
//   Mehlhorn
//      1983: at most four times the minimum number of convex parts).
// The mesh stays manifold and covers the same area; edges between regions keep their class. Triangles only; near linear.
[[nodiscard]] Merged merge_regions(Mesh mesh, Topology topology, std::vector<EdgeClass> edges, Regions regions,
                                   const MergeOptions& options);

}  // namespace fdcg::bake
