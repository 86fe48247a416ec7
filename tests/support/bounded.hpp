// SPDX-License-Identifier: Apache-2.0
// A double and how far it may be from the number that it stands for. A sign that it tells is that number's; one that it does
// not is asked of exact numbers. Some ten times a double's cost, a hundredth of an exact number's.
#pragma once

#include <cmath>

namespace fdcg::test {

struct Bounded {
  double value = 0, error = 0;
};

namespace bounded_detail {
// kUnit: half a unit in the last place, as results are rounded. kUp: more than the roundings of a bound itself, some five.
// kTiny: more than a product loses that is too small for a normal number.
inline constexpr double kUnit = 0x1p-53, kUp = 1 + 0x1p-50, kTiny = 0x1p-1000;
inline Bounded rounded(double value, double error) {
  return {value, (error + kUnit * std::abs(value)) * kUp};
}
}  // namespace bounded_detail

inline Bounded bounded_difference(double a, double b) {
  return bounded_detail::rounded(a - b, 0);
}
inline Bounded operator+(Bounded a, Bounded b) {
  return bounded_detail::rounded(a.value + b.value, a.error + b.error);
}
inline Bounded operator-(Bounded a, Bounded b) {
  return bounded_detail::rounded(a.value - b.value, a.error + b.error);
}
inline Bounded operator*(Bounded a, Bounded b) {
  const double error = std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error;
  return bounded_detail::rounded(a.value * b.value, error + bounded_detail::kTiny);
}
inline Bounded abs(Bounded a) {
  return {std::abs(a.value), a.error};
}

// 1, -1, or kDoubtful: zero too, and what has overflowed.
inline constexpr int kDoubtful = 2;
inline int sign_of(Bounded a) {
  return a.value > a.error ? 1 : a.value < -a.error ? -1 : kDoubtful;
}

}  // namespace fdcg::test
