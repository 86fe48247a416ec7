// SPDX-License-Identifier: Apache-2.0
// A fast floating-point test of two triangles, used as a filter before contact_of.
#pragma once

#include "exact/triangle_contact.hpp"

namespace fdcg::bake {

// For coordinates up to this size no product in the filter overflows, and underflow is detected.
inline constexpr double kLargestFiltered = 0x1p160;

// True only if contact_of(a, b) is `none`: a plane separates the triangles, apart from what they share, by more than the
// rounding error. False means undecided. About 20 ns; decides nearly all pairs of neighbours in a mesh.
[[nodiscard]] bool are_surely_apart(const ContactTriangle& a, const ContactTriangle& b);

}  // namespace fdcg::bake
