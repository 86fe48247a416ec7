// SPDX-License-Identifier: Apache-2.0
// `--orient`: winding made consistent within each patch, and closed patches turned outwards.
#pragma once

#include <vector>

#include "mesh.hpp"
#include "topology.hpp"

namespace fdcg::bake {

// Turns faces over in place: reverses their loops (the first corner stays first) and pairs the half-edges anew. Patches are
// sound faces joined across edges of exactly two faces.
// 1. In a patch of mixed winding the smaller part is flipped (of two equal ones that without the patch's first face).
// 2. A closed patch that encloses negative volume at an even nesting depth is flipped: what validate calls inside-out. One
//    whose winding was mixed is also flipped where it encloses positive volume at an odd depth: a cavity's walls.
// Patches that cannot be made consistent stay as they are (validate reports them); open ones keep their majority's side.
// Returns the faces that look the other way now, ascending. Near linear; faces of other patches are not touched.
std::vector<FaceId> orient(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states);

}  // namespace fdcg::bake
