// SPDX-License-Identifier: Apache-2.0
// How something grows: the exponent p of y = c x^p that fits best.
#pragma once

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fdcg::test {

using Series = std::vector<std::pair<double, double>>;  // size, what was measured

// The slope of the least-squares line through (log x, log y) over the sizes from `least_x` on. Values of 0 or less say nothing
// and are left out. NaN where fewer than two sizes remain.
inline double exponent_of(const Series& series, double least_x = 0) {
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const auto& [size, value] : series) {
    if (!(size >= least_x && size > 0 && value > 0)) continue;
    const double x = std::log(size), y = std::log(value);
    n += 1;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  const double spread = n * sum_xx - sum_x * sum_x;
  if (n < 2 || !(spread > 0)) return std::numeric_limits<double>::quiet_NaN();
  return (n * sum_xy - sum_x * sum_y) / spread;
}

}  // namespace fdcg::test
