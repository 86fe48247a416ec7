// SPDX-License-Identifier: Apache-2.0
// `--orient`: winding made consistent within each patch, and closed patches turned outwards.
#pragma once

#include <vector>

#include "base/mesh.hpp"
#include "topology/patches.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// Turns faces over in place: reverses their loops (the first corner stays first) and pairs the half-edges anew. Patches are
// sound faces joined across edges of exactly two faces.
// 1. In a patch of mixed winding the smaller part is flipped (of two equal ones that without the patch's first face). A closed
//    one then looks outwards: it is flipped as a whole where it encloses negative volume at an even nesting depth, or positive
//    volume at an odd one, as a cavity's wall.
// 2. A closed patch of one winding that encloses negative volume at an even nesting depth is flipped: what validate calls
//    inside-out.
// Patches that cannot be made consistent stay as they are (validate reports them); open ones keep their majority's side.
// Returns the faces that look the other way now, ascending. Near linear; faces of other patches are not touched.
std::vector<FaceId> orient(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states);

// The first of the two alone, or the second. `patches` are those of the mesh, before it and after it.
std::vector<FaceId> make_winding_consistent(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states,
                                            Patches& patches);
std::vector<FaceId> reverse_inside_out(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states, Patches& patches);

[[nodiscard]] Patches find_patches(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states);

}  // namespace fdcg::bake
