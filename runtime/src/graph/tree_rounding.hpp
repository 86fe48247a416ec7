// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fdcg {

// By how much a box test may be off, in tree units. `near_size`: |x| + |y| + |z| of the ends of the way as floats have it,
// added up; the rounding of the ends to float and of the sums and products in touched_boxes come to 5/8 of this part at most.
// `rounding`: the same of the whole way times the spacing at 1 of the numbers that it was given in.
template <class Real>
constexpr Real tree_rounding(Real near_size, Real rounding) {
  return Real(1) / Real(1 << 21) * (4 + near_size) + 8 * rounding;
}

}  // namespace fdcg
