// SPDX-License-Identifier: Apache-2.0
// Polygon mesh -> triangle mesh, the input of the stages from classify to merge.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"

namespace fdcg::bake {

struct Triangulation {
  Mesh mesh;  // triangles only
  Topology topology;
  std::vector<std::uint32_t> polygon;     // of each triangle: the face it was cut from; empty: the same number
  std::vector<std::uint8_t> is_whole;     // of each input face: convex, with few enough sides for one node
  std::vector<std::uint32_t> uncuttable;  // faces without a simple_view()
};

// Triangulates the polygons exactly in the projection of simple_view(); triangles are kept. Faces that the topology skips are
// left out. Meshes of triangles only pass through without a copy.
[[nodiscard]] Triangulation triangulate(Mesh mesh, Topology topology);

}  // namespace fdcg::bake
