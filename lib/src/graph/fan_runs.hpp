// SPDX-License-Identifier: Apache-2.0
// Faces that share a busy corner, put next to one another in the file (format.h, fdcg_fan_run).
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"

namespace fdcg::bake {

struct FanRun {
  std::uint32_t vertex;  // of the mesh
  std::uint32_t first, count;
};

// Moves the faces around each vertex of more than FDCG_BUSY_FAN faces behind all others, those of one vertex together and in
// the order in which they lie around it. A face of two such vertices goes to the one of more faces. Without such a vertex the
// order stays. The mesh is as order_graph takes it. Linear.
[[nodiscard]] std::vector<FanRun> gather_fans(const Mesh& mesh, const Topology& topology, std::vector<std::uint32_t>& faces);

}  // namespace fdcg::bake
