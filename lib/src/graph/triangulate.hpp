// SPDX-License-Identifier: Apache-2.0
// Polygon mesh -> triangle mesh: what the stages from classify to merge work on.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"

namespace fdcg::bake {

struct Triangulation {
  Mesh mesh;  // triangles only
  Topology topology;
  std::vector<std::uint32_t> polygon;     // of each triangle: the face it was cut from; empty: the same number
  std::vector<std::uint8_t> is_whole;     // of each face of the input: convex, and few enough sides to stay one node
  std::vector<std::uint32_t> uncuttable;  // faces without a simple_view()
};

// Cuts the polygons exactly, as simple_view() shows them; a face of three corners is kept. Faces that the topology skips are
// left out. Meshes of triangles alone pass through without a copy.
[[nodiscard]] Triangulation triangulate(Mesh mesh, Topology topology);

}  // namespace fdcg::bake
