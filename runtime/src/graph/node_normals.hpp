// SPDX-License-Identifier: Apache-2.0
// Section NODE_NORMALS: the normals of a smooth surface at the corners of the nodes, and which node and edge has such.
#pragma once

#include "fdcg/fdcg.h"
#include "graph/tolerances.hpp"
#include "shared/vec.hpp"

namespace fdcg {

// The node's own normal; in a verified file both numbers say so or neither.
inline bool is_flat_code(const uint16_t (&code)[2]) {
  return code[0] == FDCG_FLAT_NORMAL;
}
inline bool is_flat(const fdcg_node_normals& normals) {
  return is_flat_code(normals.corner[0]) && is_flat_code(normals.corner[1]) && is_flat_code(normals.corner[2]);
}

// The unit normal at corner k of a node whose own is `normal`. A code that leans from it by more than any writer allows counts
// as flat (contact-model SHADE-1).
Vec3<double> normal_at_corner(const fdcg_node_normals& normals, uint32_t k, Vec3<double> normal);

}  // namespace fdcg
