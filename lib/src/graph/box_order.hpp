// SPDX-License-Identifier: Apache-2.0
// The order of the nodes: that of the hierarchy's boxes (schemas/fdcg-v1.md, "Hierarchy").
#pragma once

#include <cstdint>
#include <span>

#include "base/mesh.hpp"

namespace fdcg::bake {

// Orders `faces` so that those which a box of the hierarchy holds lie near each other: from the top down, each run of nodes is
// split in two, at a multiple of what a box below holds, across the longest side of its faces' centres; a run of 32 or less
// along the axis that leaves the boxes with the least surface. So the boxes are small, and neighbours share pages (as when an
// R-tree is packed from the top: García, López and Leutenegger, "A greedy algorithm for bulk loading R-trees", 1998). The
// outcome depends on the set of faces alone, neither on their order nor on `jobs`. O(n log n); takes 32 bytes a face while it
// runs.
void order_by_boxes(const Mesh& mesh, std::span<std::uint32_t> faces, unsigned jobs);

}  // namespace fdcg::bake
