// SPDX-License-Identifier: Apache-2.0
// Force closure is proved either way. Yes: the origin is well inside the hull of twelve wrenches of the contacts, one along
// each axis in each direction. No: there is a direction in which no contact can exert a wrench. Where neither is found at once,
// the search over all directions that epsilon needs decides.
#include <algorithm>
#include <cmath>

#include "fdcg/grasp.hpp"
#include "grasp/grasp_epsilon.hpp"
#include "grasp/grasp_game.hpp"

namespace fdcg::grasp {
namespace {

// The least resisted disturbance is opposite to the direction in which the contacts give least.
Wrench disturbance(const Vec6& direction, double torque_scale) {
  const Vec6& u = direction;
  return {{0 - u[0], 0 - u[1], 0 - u[2]}, {0 - u[3] * torque_scale, 0 - u[4] * torque_scale, 0 - u[5] * torque_scale}};
}

struct AxisShots {
  LocalMinimum best;
  double inscribed = 0;  // radius of a ball about the origin inside the hull of the wrenches found; 0: none is proved
};

// Casts a ray along each axis in both directions. A wrench of the body at t along an axis proves t; where the wrenches are off
// their axes by at most `off`, the ball shrinks by that much.
AxisShots shoot_axes(const Body& body) {
  constexpr double kReach = 100;
  AxisShots shots{{{}, std::numeric_limits<double>::infinity()}, 0};
  double inverse_squares = 0, off = 0;
  for (std::size_t k = 0; k < kDimensions; ++k) {
    double shorter = std::numeric_limits<double>::infinity();
    for (const double sign : {1.0, -1.0}) {
      Vec6 axis{};
      axis[k] = sign;
      const auto corners = around(axis, kReach, body.dimensions);
      const GameResult game = play(body, {corners.data(), body.dimensions}, body.support(axis).wrench, axis, {});
      const Vec6 direction = unit(game.direction);
      const double value = body.value(direction);
      if (value < shots.best.value) shots.best = {direction, value};
      Vec6 aside = game.wrench;
      const double along = sign * aside[k];
      aside[k] = 0;
      shorter = std::min(shorter, along);
      off = std::max(off, norm(aside));
    }
    inverse_squares += shorter > 0 ? 1 / (shorter * shorter) : std::numeric_limits<double>::infinity();
  }
  // The octahedron with half-axes t_k holds a ball of radius 1 / sqrt(sum of 1 / t_k^2).
  shots.inscribed = std::max(0.0, 1 / std::sqrt(inverse_squares) - off);
  return shots;
}

bool is_flat_along(const Body& body, const Vec6& direction) {
  return std::abs(body.value(direction)) <= kTolerance && std::abs(body.value(scaled(-1, direction))) <= kTolerance;
}

struct Judged {
  Closure closure;
  LocalMinimum best;
};

Judged judge(const Grasp& grasp, const Body& body) {
  Judged judged;
  const AxisShots shots = shoot_axes(body);
  judged.best = descend(body, shots.best.direction);
  double lower = shots.inscribed;
  if (!(lower > kTolerance) && judged.best.value > kTolerance) {
    // Thin in a direction between the axes, or open in a direction that no ray has tested.
    constexpr std::uint64_t kCells = 200'000;
    const LeastSupport search = least_support(body, judged.best, kCells);
    judged.best = search.best;
    lower = std::max(0.0, search.lower);
  }
  Closure& closure = judged.closure;
  closure.upper = judged.best.value;
  closure.lower = closure.upper > kTolerance ? std::min(lower, closure.upper) : -std::numeric_limits<double>::infinity();
  closure.is_flat = is_flat_along(body, judged.best.direction);
  closure.weakest = disturbance(judged.best.direction, grasp.torque_scale_m);
  if (closure.lower > kTolerance) {
    closure.verdict = Verdict::closure;
  } else if (closure.upper < -kTolerance || closure.is_flat) {
    closure.verdict = Verdict::no_closure;
  }
  return judged;
}

// Each contact presses with 1 N.
Body sum_of(Body body) {
  body.must_press = false;
  std::fill(body.caps_n.begin(), body.caps_n.end(), 1.0);
  body.total_n = std::numeric_limits<double>::infinity();
  return body;
}

}  // namespace

Closure force_closure(const Grasp& grasp) {
  return judge(grasp, unit_body(grasp)).closure;
}

Epsilon ferrari_canny(const Grasp& grasp, Effort effort, std::uint64_t max_cells, const bake::Progress& progress) {
  Body body = unit_body(grasp);
  const Judged judged = judge(grasp, body);
  Epsilon epsilon;
  epsilon.weakest = judged.closure.weakest;
  if (judged.closure.verdict != Verdict::closure) {
    const bool is_known = judged.closure.verdict == Verdict::no_closure;
    epsilon.value = is_known ? 0 : std::max(0.0, judged.closure.upper);
    epsilon.is_tight = epsilon.value <= kTolerance;
    return epsilon;
  }
  LocalMinimum start = judged.best;
  if (effort == Effort::each) {
    body = sum_of(std::move(body));
    start = descend(body, start.direction);
  }
  for (std::size_t k = 0; k < 2 * kDimensions; ++k) {
    Vec6 axis{};
    axis[k / 2] = k % 2 == 0 ? 1 : -1;
    const LocalMinimum found = descend(body, axis);
    if (found.value < start.value) start = found;
  }
  const LeastSupport least = least_support(body, start, max_cells, progress);
  epsilon.value = least.best.value;
  epsilon.lower = least.lower;
  epsilon.is_tight = epsilon.value - epsilon.lower <= kTolerance;
  epsilon.weakest = disturbance(least.best.direction, grasp.torque_scale_m);
  epsilon.cells = least.cells;
  return epsilon;
}

}  // namespace fdcg::grasp
