// SPDX-License-Identifier: Apache-2.0
// The tree of a busy corner (format.h, fdcg_fan_box): boxes around the directions that the corner's edges and faces offer, so
// that the step finds the steepest of ten thousand by opening some twenty.
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

// How many boxes a corner of so many entries has: 0 where it is not busy.
[[nodiscard]] std::uint32_t fan_box_count(std::uint32_t fan_entries);

// Its boxes, root first, level after level. `epsilon` is that of the stored numbers. Near linear in the entries.
[[nodiscard]] std::vector<FanBox> build_fan_tree(std::span<const FanDirection> fan, double epsilon);

}  // namespace fdcg::bake
