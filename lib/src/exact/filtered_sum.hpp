// SPDX-License-Identifier: Apache-2.0
// A floating-point filter in front of exact arithmetic: the sign of a sum of 2 x 2 determinants where the error bound proves
// it.
#pragma once

#include <cmath>
#include <limits>

namespace fdcg::bake {

// A sum of 2 x 2 determinants with a bound on its rounding error.
struct FilteredSum {
  double value = 0, magnitude = 0;
  void add(double a, double b, double c, double d) {
    const double p = a * d, q = b * c;
    value += p - q;
    magnitude += std::abs(p) + std::abs(q);
  }
  // Entries are rounded differences (u each, u = 2^-53), products and their difference add 2u more, the sum u a term; the rest
  // covers products of these and the rounding of the bound. Below 1e-280 underflow could interfere.
  [[nodiscard]] bool is_certain(double terms) const {
    return std::abs(value) > (terms + 8) * 0x1p-53 * magnitude && magnitude > 1e-280 &&
           magnitude < std::numeric_limits<double>::max();
  }
};

}  // namespace fdcg::bake
