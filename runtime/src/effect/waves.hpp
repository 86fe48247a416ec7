// SPDX-License-Identifier: Apache-2.0
// Sine, decay and noise by sums and products alone: the same bits on every processor, and no call of a mathematics library.
#pragma once

#include <stdint.h>

#include "fdcg/effect.h"

namespace fdcg {

struct SineCosine {
  double sine, cosine;
};

// Of 2 pi turns, turns within -1e15 to 1e15. Exact to 1e-15 within -1 to 1.
inline SineCosine sine_cosine_of_turns(double turns) {
  constexpr double kTurn = 6.283185307179586476925;
  const auto quarters = static_cast<int64_t>(4 * turns + (turns < 0 ? -0.5 : 0.5));  // the nearest
  const double x = kTurn * (turns - 0.25 * static_cast<double>(quarters)), y = x * x;
  // within an eighth of a turn, by their series; in pairs, which a processor does side by side
  const double y2 = y * y, y4 = y2 * y2;
  const double odd = (-1.0 / 6 + y * (1.0 / 120)) + y2 * (-1.0 / 5040 + y * (1.0 / 362880)) +
                     y4 * ((-1.0 / 39916800 + y * (1.0 / 6227020800)) - y2 * (1.0 / 1307674368000));
  const double even = (-1.0 / 2 + y * (1.0 / 24)) + y2 * (-1.0 / 720 + y * (1.0 / 40320)) +
                      y4 * ((-1.0 / 3628800 + y * (1.0 / 479001600)) - y2 * (1.0 / 87178291200));
  const double sine = x + x * y * odd, cosine = 1 + y * even;
  const double swapped[2] = {(quarters & 1) != 0 ? cosine : sine, (quarters & 1) != 0 ? sine : cosine};
  return {(quarters & 2) != 0 ? -swapped[0] : swapped[0], ((quarters + 1) & 2) != 0 ? -swapped[1] : swapped[1]};
}
inline double sine_of_turns(double turns) {
  return sine_cosine_of_turns(turns).sine;
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
