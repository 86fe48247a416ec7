// SPDX-License-Identifier: Apache-2.0
// Sums and products of doubles without rounding error, the same on every processor, with a fused multiplication or without.
#pragma once

#include "shared/vec.hpp"

namespace fdcg {

// An unevaluated sum: the value and what rounding it left over, at most half a unit in the last place of the value.
struct Split {
  double value, rest;
};

// a + b exactly (Knuth).
FDCG_HOT Split exact_sum(double a, double b) {
  const double value = a + b, from_b = value - a, from_a = value - from_b;
  return {value, (a - from_a) + (b - from_b)};
}

// a - b exactly.
FDCG_HOT Split exact_difference(double a, double b) {
  return exact_sum(a, -b);
}

// a * b exactly (Dekker), barring underflow.
FDCG_HOT Split exact_product(double a, double b) {
  constexpr double kSplitter = 134217729;  // 2^27 + 1
  const double ca = kSplitter * a, cb = kSplitter * b;
  const double a_high = ca - (ca - a), b_high = cb - (cb - b);
  const double a_low = a - a_high, b_low = b - b_high;
  const double value = a * b;
  return {value, a_low * b_low - (((value - a_high * b_high) - a_low * b_high) - a_high * b_low)};
}

}  // namespace fdcg
