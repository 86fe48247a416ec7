// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/mesh.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

struct Duplicate {
  FaceId copy, first;
};

// Faces with the same corners, in whatever order and winding, as an earlier face: each with the earliest of them, ascending.
// Faces with an invalid corner are left out. Linear but for the sorting of the few that may be copies.
[[nodiscard]] std::vector<Duplicate> duplicate_faces(const Mesh& mesh, const Topology& topology,
                                                     const std::vector<FaceState>& states);

}  // namespace fdcg::bake
