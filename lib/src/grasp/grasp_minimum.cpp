// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_minimum.hpp"

#include <cmath>

#include "grasp/grasp_game.hpp"

namespace fdcg::grasp {

LocalMinimum descend(const Body& body, const Vec6& from) {
  constexpr int kSteps = 100;
  constexpr double kReach = 4;  // far enough for long steps, near enough for numbers of order one
  constexpr double kLeastGain = 1e-13;
  LocalMinimum minimum{from, body.value(from)};
  for (int step = 0; step < kSteps; ++step) {
    // The minimum in the tangent plane of the sphere here. Projected onto the sphere it is lower still, being nearer the
    // origin.
    const auto corners = around(minimum.direction, kReach, body.dimensions);
    const SupportPoint start = body.support(minimum.direction);
    const GameResult game = play(body, {corners.data(), body.dimensions}, start.wrench, minimum.direction, {});
    const Vec6 direction = unit(game.direction);
    const double value = body.value(direction);
    const double gain = minimum.value - value;
    if (!(gain > 0)) break;  // NaN too
    minimum = {direction, value};
    if (gain < kLeastGain) break;
  }
  return minimum;
}

}  // namespace fdcg::grasp
