// SPDX-License-Identifier: Apache-2.0
// The quantum of coordinates that a format stores as multiples of a grid step (Draco, KHR_mesh_quantization), or that a program
// gives.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// `half_step`, but at most a thousandth of the largest coordinate: on a grid of fewer than 500 steps the shape was designed on
// the grid rather than rounded to it, and a tolerance of half a step would flatten its features.
inline double at_most_a_share(double half_step, const std::vector<Vec3>& points) {
  constexpr double kLargestShare = 1e-3;
  double extent = 0;
  for (const Vec3& p : points) {
    for (const double c : {p.x, p.y, p.z}) {
      if (std::isfinite(c)) extent = std::max(extent, std::fabs(c));
    }
  }
  return std::min(half_step, kLargestShare * extent);
}

}  // namespace fdcg::bake
