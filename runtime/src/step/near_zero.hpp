// SPDX-License-Identifier: Apache-2.0
// Which coordinates count as zero, in a HIP and in a corner that is moved alike.
#pragma once

#include "graph/tolerances.hpp"
#include "shared/vec.hpp"

namespace fdcg {

inline double zero_below(double least, double x) {
  return absolute(x) < least ? 0 : x;
}
// Asked first, since a branch that is foreseen takes less time than three choices of a number on which all else waits. Of
// numbers, not NaN.
inline bool has_below(double least, Vec3<double> p) {
  return smaller(smaller(absolute(p.x), absolute(p.y)), absolute(p.z)) < least;
}

}  // namespace fdcg
