// SPDX-License-Identifier: Apache-2.0
// Holes: the closed ways along boundary edges.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"

namespace fdcg::bake {

struct BoundaryLoop {
  std::vector<VertexId> corners;  // in the order in which a patch that closes the hole runs; each once
  std::vector<FaceId> faces;      // at the edge from each corner to the next
  double size = 0;                // the diagonal of its bounds
  bool is_slit = false;           // its corners are exactly collinear: there is nothing to close
};

// All loops, by their first half-edges. Where faces along a way run in different directions it does not close, and is left out.
[[nodiscard]] std::vector<BoundaryLoop> boundary_loops(const Mesh& mesh, const Topology& topology);

}  // namespace fdcg::bake
