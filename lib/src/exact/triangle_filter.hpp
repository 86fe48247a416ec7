// SPDX-License-Identifier: Apache-2.0
// A quick look at two triangles in floating point, before contact_of is asked.
#pragma once

#include "exact/triangle_contact.hpp"

namespace fdcg::bake {

// Coordinates up to this size are safe: no product in the filter overflows, and underflow is told apart.
inline constexpr double kLargestFiltered = 0x1p160;

// True only if contact_of(a, b) is `none`: a plane with rounding errors allowed for lies between them, or between all but what
// they share. False is no answer. Some 20 ns; nearly all neighbours of a mesh are told apart by it.
[[nodiscard]] bool are_surely_apart(const ContactTriangle& a, const ContactTriangle& b);

}  // namespace fdcg::bake
