// SPDX-License-Identifier: Apache-2.0
// Sine, decay and noise by sums and products alone: the same bits on every processor, and no call of a mathematics library.
#pragma once

#include <stdint.h>

#include "fdcg/effect.h"

namespace fdcg {

// sin(2 pi turns), turns within -1 to 1. Exact to 1e-15.
inline double sine_of_turns(double turns) {
  constexpr double kTurn = 6.283185307179586476925;
  double t = turns > 0.5 ? turns - 1 : turns < -0.5 ? turns + 1 : turns;
  t = t > 0.25 ? 0.5 - t : t < -0.25 ? -0.5 - t : t;
  const double x = kTurn * t, square = x * x;
  double sum = 0;  // x - x^3 / 3! + ..., from the smallest
  for (int n = 19; n >= 3; n -= 2)
    sum = (1 + sum) * (-square / (n * (n - 1)));
  return x + x * sum;
}

// exp(-x), x >= 0. Exact to 1e-13.
inline double decay(double x) {
  constexpr double kGone = 700;
  if (!(x < kGone)) return 0;
  int halvings = 0;
  for (; x > 0.125; x /= 2)
    ++halvings;
  double sum = 1;
  for (int n = 10; n >= 1; --n)
    sum = 1 - sum * x / n;
  for (; halvings > 0; --halvings)
    sum *= sum;
  return sum;
}

// The next of a series of white noise: mean 0, variance 1, nearly normal, within -3.5 to 3.5 (xorshift64*, Vigna 2016; the sum
// of four uniform numbers of 16 bits).
inline double next_noise(uint64_t* state) {
  uint64_t x = *state;
  x ^= x >> 12;
  x ^= x << 25;
  x ^= x >> 27;
  *state = x;
  const uint64_t bits = x * 0x2545F4914F6CDD1DU;
  constexpr double kScale = 1.7320508075688772 / 65536, kMean = 2 * 65535.0;
  const double sum = static_cast<double>((bits & 0xFFFF) + (bits >> 16 & 0xFFFF) + (bits >> 32 & 0xFFFF) + (bits >> 48));
  return (sum - kMean) * kScale;
}
inline uint64_t first_noise(uint32_t seed) {
  return (uint64_t{seed} + 1) * 0x9E3779B97F4A7C15U;
}

}  // namespace fdcg
