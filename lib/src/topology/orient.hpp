// SPDX-License-Identifier: Apache-2.0
// `--orient`: winding made consistent within each patch, and closed patches turned outwards.
#pragma once

#include <vector>

#include "base/mesh.hpp"
#include "topology/patches.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// Flips faces in place: reverses their loops (the first corner stays first) and rebuilds the twins. Patches are sets of sound
// faces connected across edges of exactly two faces.
// 1. In a patch of mixed winding the smaller part is flipped (of two equal ones that without the patch's first face). A closed
//    one is then oriented outwards: it is flipped where it encloses negative volume at an even nesting depth, or positive
//    volume at an odd one, as a cavity's wall.
// 2. A closed patch of one winding that encloses negative volume at an even nesting depth is flipped: what validate calls
//    inside-out.
// Patches that cannot be made consistent are not changed (validate reports them); open ones keep the orientation of the
// majority. Returns the flipped faces, ascending. Near linear; other patches are not changed.
std::vector<FaceId> orient(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states);

// Step 1 alone, and step 2 alone. `patches` are those of the mesh, and are updated.
std::vector<FaceId> make_winding_consistent(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states,
                                            Patches& patches);
std::vector<FaceId> reverse_inside_out(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states, Patches& patches);

[[nodiscard]] Patches find_patches(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states);

}  // namespace fdcg::bake
