// SPDX-License-Identifier: Apache-2.0
// Sine, decay and noise by sums and products alone: the same bits on every processor, and no call of a mathematics library.
#pragma once

#include <stdint.h>
#include <string.h>

#include "fdcg/effect.h"

namespace fdcg {

// Two numbers side by side.
using Two = double __attribute__((vector_size(16)));
using TwoBits = int64_t __attribute__((vector_size(16)));

inline TwoBits bits_of(Two a) {
  return reinterpret_cast<TwoBits>(a);
}
struct SineCosine {
  double sine, cosine;
};

// Of 2 pi turns, turns within -2^48 to 2^48. Exact to 1e-15 within -1 to 1. Both by one row of operations, side by side.
inline SineCosine sine_cosine_of_turns(double turns) {
  constexpr double kQuarterTurn = 6.283185307179586476925 / 4, kWhole = 0x1.8p52;  // whole numbers alone are near it
  const double shifted = 4 * turns + kWhole, x = kQuarterTurn * (4 * turns - (shifted - kWhole)), y = x * x;
  int64_t quarters;  // its last bits are those of the nearest whole number
  memcpy(&quarters, &shifted, sizeof quarters);
  // within an eighth of a turn, by their series; in pairs, which a processor does side by side
  const double y2 = y * y, y4 = y2 * y2;
  const Two series = (Two{-1.0 / 6, -1.0 / 2} + y * Two{1.0 / 120, 1.0 / 24}) +
                     y2 * (Two{-1.0 / 5040, -1.0 / 720} + y * Two{1.0 / 362880, 1.0 / 40320}) +
                     y4 * ((Two{-1.0 / 39916800, -1.0 / 3628800} + y * Two{1.0 / 6227020800, 1.0 / 479001600}) -
                           y2 * Two{1.0 / 1307674368000, 1.0 / 87178291200});
  const Two found = Two{x, 1} + Two{x * y, y} * series, swapped = {found[1], found[0]};
  const int64_t odd = -(quarters & 1);  // a choice by bits, since a branch cannot be foreseen
  const TwoBits chosen = (bits_of(found) & ~TwoBits{odd, odd}) | (bits_of(swapped) & TwoBits{odd, odd});
  const auto sign = [](int64_t quarter) { return static_cast<int64_t>(static_cast<uint64_t>(quarter & 2) << 62); };
  const Two result = reinterpret_cast<Two>(chosen ^ TwoBits{sign(quarters), sign(quarters + 1)});
  return {result[0], result[1]};
}
struct SinesCosines {
  Two sine, cosine;
};

// The same of two, each by a lane of its own, with fewer terms: exact to 2e-9.
inline SinesCosines sines_cosines_of_turns(Two turns) {
  constexpr double kTurn = 6.283185307179586476925, kQuarters = 0x1.8p50;  // whole quarters alone are near it
  const Two shifted = turns + kQuarters, x = kTurn * (turns - (shifted - kQuarters)), y = x * x, y2 = y * y;
  const Two odd = (-1.0 / 6 + y * (1.0 / 120)) + y2 * (-1.0 / 5040 + y * (1.0 / 362880));
  const Two even = (-1.0 / 2 + y * (1.0 / 24)) + y2 * ((-1.0 / 720 + y * (1.0 / 40320)) - y2 * (1.0 / 3628800));
  const TwoBits sine = bits_of(x + x * y * odd), cosine = bits_of(1 + y * even), last = bits_of(shifted);
  const TwoBits exchanged = (sine ^ cosine) & -(last & 1);
  const auto sign = [](TwoBits quarter) {
    using Unsigned = uint64_t __attribute__((vector_size(16)));
    return reinterpret_cast<TwoBits>(reinterpret_cast<Unsigned>(quarter & 2) << 62);
  };
  return {reinterpret_cast<Two>(sine ^ exchanged ^ sign(last)), reinterpret_cast<Two>(cosine ^ exchanged ^ sign(last + 1))};
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
