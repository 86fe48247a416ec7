// SPDX-License-Identifier: Apache-2.0
// Pairing of half-edges.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"

namespace fdcg::bake {

// A face that the rules of edges and vertices ignore: fewer than three corners, a repeated corner, or a corner with an invalid
// index.
enum class FaceState : std::uint8_t { sound, repeated_corner, invalid_corner };

// Both use `jobs` threads; the result does not depend on it.

// The state of each face; `invalid_corner` where both hold. Linear in the corners.
[[nodiscard]] std::vector<FaceState> face_states(const Mesh& mesh, unsigned jobs = 1);

// Pairs the half-edges of all sound faces (exactly: combinatorics alone, no coordinate is read). `states` as face_states
// gives them, or with further faces marked that the caller wants left out. Buckets by the smaller vertex: linear time and
// memory, 8 bytes a corner of working space; a vertex of k edges costs k log k. Topology::face_of stays empty only where every
// face has three corners.
[[nodiscard]] Topology pair_halfedges(const Mesh& mesh, const std::vector<FaceState>& states, unsigned jobs = 1);
[[nodiscard]] Topology pair_halfedges(const Mesh& mesh);

}  // namespace fdcg::bake
