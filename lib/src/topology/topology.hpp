// SPDX-License-Identifier: Apache-2.0
// Which half-edge lies across which.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"

namespace fdcg::bake {

// A face that takes no part in the rules of edges and vertices: fewer than three corners, a corner named twice, or a corner
// that names no vertex.
enum class FaceState : std::uint8_t { sound, repeated_corner, invalid_corner };

// Both on `jobs` threads, on which the outcome does not depend.

// The state of each face; `invalid_corner` where both hold. Linear in the corners.
[[nodiscard]] std::vector<FaceState> face_states(const Mesh& mesh, unsigned jobs = 1);

// Pairs the half-edges of all sound faces (exactly: combinatorics alone, no coordinate is read). `states` as face_states
// gives them, or with further faces marked that the caller wants left out. Buckets by the smaller vertex: linear time and
// memory, 8 bytes a corner of working space; a vertex of k edges costs k log k. Topology::face_of stays empty only where every
// face has three corners.
[[nodiscard]] Topology pair_halfedges(const Mesh& mesh, const std::vector<FaceState>& states, unsigned jobs = 1);
[[nodiscard]] Topology pair_halfedges(const Mesh& mesh);

}  // namespace fdcg::bake
