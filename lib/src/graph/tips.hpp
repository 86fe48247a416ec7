// SPDX-License-Identifier: Apache-2.0
// Vertices at which many planes meet.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "graph/regions.hpp"

namespace fdcg::bake {

// Marks, of the vertices of more than FDCG_BUSY_FAN faces, those at which more than `most_planes` planes meet, of regions and
// of faces on their own. True: one was not marked before. `is_tip` has an entry for each vertex. Triangles only. Linear.
bool mark_tips(const Mesh& mesh, const Topology& topology, const Regions& regions, std::uint32_t most_planes,
               std::vector<bool>& is_tip);

}  // namespace fdcg::bake
