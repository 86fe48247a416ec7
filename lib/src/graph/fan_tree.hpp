// SPDX-License-Identifier: Apache-2.0
// The box tree of a corner with many edges (format.h, fdcg_fan_box): bounding boxes of the directions of the corner's edges and
// faces, so that the step finds the steepest of ten thousand directions by visiting about twenty boxes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// The unit directions in the box: centre + sum of s_k axis[k], |s_k| <= 1.
struct FanBox {
  Vec3 centre;
  Vec3 axis[3];
};

// One fan entry as the file stores it: the edge's unit direction away from the corner and the unit normal of the face to its
// left, which ends at the next entry's edge; zero where there is none.
struct FanDirection {
  Vec3 edge;
  Vec3 face_normal;
};

// Number of boxes of a corner with so many fan entries: 0 where it has too few for a tree.
[[nodiscard]] std::uint32_t fan_box_count(std::uint32_t fan_entries);

// Its boxes, root first, level after level. `epsilon` is that of the stored numbers. Near linear in the entries.
[[nodiscard]] std::vector<FanBox> build_fan_tree(std::span<const FanDirection> fan, double epsilon);

}  // namespace fdcg::bake
