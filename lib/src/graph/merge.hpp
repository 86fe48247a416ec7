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
  bool across_faces = true;  // false: only the triangles of one and the same polygon come together again
  Coplanar coplanar;
  Quantum quantum;
  const std::vector<std::uint32_t>* polygon = nullptr;  // of each triangle: the polygon it was cut from; null: none was cut
};

struct Merged {
  Mesh mesh;  // convex polygons
  Topology topology;
  std::vector<EdgeClass> edges;
  Regions regions;
  std::vector<std::uint32_t> face_of_triangle;  // of each triangle given: the polygon where its centre now lies; empty: itself
};

// Inside each region, seen along one axis, exactly:
//   1. vertices inside the region go, and those between two straight edges of the same two regions (or of one and the open
//      boundary) go from both sides at once; the hole is cut into triangles anew. Straight is exactly so or, unless `coplanar`
//      is exact, with every vertex that the edge has swallowed within kQuantumReach of the largest quantum of it and the ends;
//   2. diagonals are dropped, longest first, while the polygon stays convex and has at most kMaxMergedSides sides
//      (Hertel and Mehlhorn 1983: at most four times the fewest pieces).
// The mesh stays manifold and covers the same area; edges between regions keep their class. Triangles only; near linear.
[[nodiscard]] Merged merge_regions(Mesh mesh, Topology topology, std::vector<EdgeClass> edges, Regions regions,
                                   const MergeOptions& options);

}  // namespace fdcg::bake
