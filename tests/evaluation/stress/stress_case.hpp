// SPDX-License-Identifier: Apache-2.0
// The cases of docs/internals/contact-model.md#9-what-holds-of-every-tick, one row each: which bodies, which hands, and what
// must hold beside the bars that hold for all of them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hand.hpp"
#include "specimen.hpp"

namespace fdcg::test {

struct StressCase {
  std::string_view name;
  std::string_view target;  // in words; the judges of judge.hpp are the same for every case
  Body (*make)(Random& random, bake::Precision precision);
  std::vector<Motion> motions;  // drawn from, with equal chances
  // Work may be carried over to the next tick: where HIPs and ways come within rounding of planes, edges and corners, whose
  // exact signs are a tick's work by the dozen; and where hundreds of faces may be crossed in one tick.
  bool may_carry = false;
  std::uint32_t blocks_per_body = 1;
  double share = 1;         // of the ticks; dear ones get less
  bool owes_force = false;  // the hand has a hand's speed: no sweep is carried over, no tick inside is without force
};

const std::vector<StressCase>& stress_cases();

// Static and dynamic coefficients that every case draws from.
inline constexpr double kFrictionPairs[][2] = {{0, 0}, {0, 0}, {0.1, 0.1}, {0.3, 0.2}, {0.6, 0.4}, {1, 0.999}, {2, 1}, {20, 0}};

}  // namespace fdcg::test
