// SPDX-License-Identifier: Apache-2.0
// Contacts that close and turn while a button is held.
#include "tick/grip.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "catch.hpp"

using namespace fdcg::dev;

namespace {

Grip quarter_turn() {
  Grip grip;
  grip.close = {1, 0.5};
  grip.turn = {4, 1};
  grip.closed_m[1][0] = 0.01;
  grip.turn_xyzw[2] = grip.turn_xyzw[3] = std::sqrt(0.5);
  return grip;
}

}  // namespace

TEST_CASE("grip: a held button closes in its time, a released one opens, others do nothing") {
  const Grip grip = quarter_turn();
  GripState state;
  for (int tick = 0; tick < 250; ++tick)
    move_grip(grip, 1, 0.001, &state);
  CHECK(state.closed == Approx(0.5));
  CHECK(state.turned == 0);
  for (int tick = 0; tick < 1000; ++tick)
    move_grip(grip, 1 | 2, 0.001, &state);
  CHECK(state.closed == 1);
  for (int tick = 0; tick < 250; ++tick)
    move_grip(grip, 4 | 8, 0.001, &state);
  CHECK(state.closed == Approx(0.5));
  CHECK(state.turned == Approx(0.25));
  for (int tick = 0; tick < 1000; ++tick)
    move_grip(grip, 0, 0.001, &state);
  CHECK(state.closed == 0);
  CHECK(state.turned == 0);
}

TEST_CASE("grip: a contact moves smoothly from open to closed, and turns about the tip") {
  const Grip grip = quarter_turn();
  const double open_m[3] = {0.03, 0.001, -0.002};
  GripState state;
  double at_m[3], before_m[3];
  grip_offset(grip, state, 1, open_m, before_m);
  for (int i = 0; i < 3; ++i)
    CHECK(before_m[i] == open_m[i]);
  double most = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    move_grip(grip, tick < 700 ? 1 : 5, 0.001, &state);
    grip_offset(grip, state, 1, open_m, at_m);
    for (int i = 0; i < 3; ++i) {
      most = std::max(most, std::fabs(at_m[i] - before_m[i]));
      before_m[i] = at_m[i];
    }
  }
  CHECK(most < 2 * 0.03 / 500);
  // closed at (0.01, 0, 0), then a quarter about z
  CHECK(std::fabs(at_m[0]) < 1e-15);
  CHECK(std::fabs(at_m[1] - 0.01) < 1e-15);
  CHECK(std::fabs(at_m[2]) < 1e-15);
}

TEST_CASE("grip: a turn keeps every distance from the tip") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 1000; ++round) {
    Grip grip;
    grip.turn = {1, 1};
    double length = 0;
    for (double& x : grip.turn_xyzw) {
      x = normal(random);
      length += x * x;
    }
    for (double& x : grip.turn_xyzw)
      x /= std::copysign(std::sqrt(length), grip.turn_xyzw[3]);
    const double open_m[3] = {normal(random), normal(random), normal(random)};
    GripState state;
    state.turned = std::uniform_real_distribution<double>(0, 1)(random);
    double at_m[3];
    grip_offset(grip, state, 0, open_m, at_m);
    CHECK(std::hypot(at_m[0], at_m[1], at_m[2]) == Approx(std::hypot(open_m[0], open_m[1], open_m[2])).epsilon(1e-14));
  }
}
