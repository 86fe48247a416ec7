// SPDX-License-Identifier: Apache-2.0
// Which coordinates count as zero, in a HIP and in a corner that is moved alike.
#pragma once

#include "shared/vec.hpp"

namespace fdcg {

// A coordinate smaller than this share of the extent is zero: no hand can tell, and exact signs need not look at bits that
// stand further apart than a few machine words hold (contact-model TICK-4).
inline constexpr double kLeastShare = 0x1p-70;

inline double zero_below(double least, double x) {
  return absolute(x) < least ? 0 : x;
}
// Asked first, since a branch that is foreseen takes less time than three choices of a number on which all else waits. Of
// numbers, not NaN.
inline bool has_below(double least, Vec3<double> p) {
  return smaller(smaller(absolute(p.x), absolute(p.y)), absolute(p.z)) < least;
}

}  // namespace fdcg
