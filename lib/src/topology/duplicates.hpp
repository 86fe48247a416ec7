// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/mesh.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

struct Duplicate {
  FaceId copy, first;
};

// Faces with the same set of corners as an earlier face, in any order and winding: each with the earliest such face, ascending.
// Faces with an invalid corner are left out. Linear, plus sorting of the few candidates.
[[nodiscard]] std::vector<Duplicate> duplicate_faces(const Mesh& mesh, const Topology& topology,
                                                     const std::vector<FaceState>& states);

}  // namespace fdcg::bake
