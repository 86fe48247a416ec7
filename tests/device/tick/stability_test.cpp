// SPDX-License-Identifier: Apache-2.0
// The stage of stability in a loop with a hand: a mass on the hand's spring and damper, pressed on a wall whose force comes
// late.
#include "tick/stability.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "catch.hpp"
#include "gate_limits.hpp"
#include "tick/gate.hpp"

using namespace fdcg::dev;
using fdcg::test::sound_limits;

namespace {

constexpr double kForceLimit_n = 5, kQuantum_m = 1e-5;
constexpr double kTurn = 6.283185307179586;

DeviceLimits limits_of_loop() {
  DeviceLimits limits = sound_limits();
  limits.force_n = kForceLimit_n;
  std::fill_n(limits.effort, 3, kForceLimit_n);
  limits.slew_n_per_s = kForceLimit_n / 0.005;
  limits.velocity_m_per_s = 10;
  std::fill_n(limits.workspace_min_m, 3, -1.0);
  std::fill_n(limits.workspace_max_m, 3, 1.0);
  return limits;
}

struct Loop {
  double mass_kg = 0.1, stiffness_n_per_m = 1000, rate_hz = 1000, delay_s = 0;
  bool has_stage = true, is_delay_known = true;
  double hand_n_per_m = 300, device_n_s_per_m = 0.5;
  double hand_ratio = 0.3;  // of the hand's damping to the critical one of its own spring
};

struct Seen {
  std::vector<double> force_n;  // felt, a tick each
  double given_j = 0;           // the most that the device has given to the hand, in all, at any time
  double calmed = 0, most_damping = 0;
  bool is_disarmed = false;
};

// From 10 mm above to 5 mm into the wall within a second, then held for four.
double press(double time_s) {
  return 0.01 - 0.015 * std::clamp(time_s - 1, 0.0, 1.0);
}

template <class Hand>
Seen run(const Loop& loop, double seconds, const Hand& hand) {
  const DeviceLimits limits = limits_of_loop();
  Gate gate;
  gate.begin(limits, 3, loop.rate_hz, 0);
  Stability stage;
  StabilitySetup setup;
  setup.has_passivity = setup.has_calming = loop.has_stage;
  setup.stiffness_n_per_m = loop.stiffness_n_per_m;
  stage.begin(setup, limits, loop.rate_hz);
  const double period_s = 1 / loop.rate_hz;
  const double hand_n_s_per_m = std::max(1.0, 2 * loop.hand_ratio * std::sqrt(loop.hand_n_per_m * loop.mass_kg));
  std::deque<double> under_way(static_cast<std::size_t>(std::lround(loop.delay_s * loop.rate_hz)), 0.0);
  Seen seen;
  double x = hand(0.0), v = 0, given_j = 0;
  GateInput input;
  input.tip.jacobian[0][0] = input.tip.jacobian[1][1] = input.tip.jacobian[2][2] = 1;
  input.has_sample = true;
  const int ticks = static_cast<int>(seconds * loop.rate_hz);
  for (int tick = 0; tick < ticks; ++tick) {
    const double time_s = tick * period_s, place_m = std::nearbyint(x / kQuantum_m) * kQuantum_m;
    double force_n[3] = {0, 0, loop.stiffness_n_per_m * std::max(0.0, -place_m)};
    input.now_ns = static_cast<std::uint64_t>((1 + time_s) * 1e9);
    input.tip.position_m[2] = place_m;
    input.arm = tick == 20;
    stage.step(input.tip.position_m, input.now_ns, gate.last_force_n(), loop.is_delay_known ? loop.delay_s + period_s : 0,
               false, force_n);
    std::copy_n(force_n, 3, input.wanted_force_n);
    input.link_fault = stage.shakes() ? Fault::kShaking : Fault::kNone;
    under_way.push_back(gate.step(input).force_n()[2]);
    const double felt_n = under_way.front();
    under_way.pop_front();
    seen.force_n.push_back(felt_n);
    seen.is_disarmed = seen.is_disarmed || (tick > 20 && gate.phase() == Phase::kDisarmed);
    seen.most_damping = std::max(seen.most_damping, stage.damping());
    constexpr int kParts = 20;
    for (int part = 0; part < kParts; ++part) {
      const double hand_n = loop.hand_n_per_m * (hand(time_s) - x) - hand_n_s_per_m * v;
      v += (felt_n + hand_n - loop.device_n_s_per_m * v) / loop.mass_kg * (period_s / kParts);
      x += v * (period_s / kParts);
      given_j += felt_n * v * (period_s / kParts);
    }
    seen.given_j = std::max(seen.given_j, given_j);
  }
  seen.calmed = 1 - stage.share();
  return seen;
}

// The longest time for which the force swings by 5 % of the limit to each side, each swing at least 0.9 of the one before.
double longest_swinging_s(const Seen& seen, double rate_hz) {
  constexpr double kSwing_n = 2 * 0.05 * kForceLimit_n, kPauseS = 0.125;
  double longest_s = 0, since_s = 0, last_s = -1, turned = seen.force_n[0], extreme = turned, swing = 0;
  int direction = 0;
  for (std::size_t tick = 0; tick < seen.force_n.size(); ++tick) {
    const double time_s = static_cast<double>(tick) / rate_hz, force = seen.force_n[tick];
    if (direction == 0) {
      if (std::fabs(force - turned) > kSwing_n) direction = force > turned ? 1 : -1;
      extreme = force;
      continue;
    }
    if (direction * (force - extreme) > 0) extreme = force;
    if (direction * (extreme - force) < kSwing_n) continue;
    const double now = std::fabs(extreme - turned);
    if (last_s < 0 || time_s - last_s > kPauseS || now < 0.9 * swing) since_s = time_s;
    last_s = time_s;
    swing = now;
    turned = extreme;
    extreme = force;
    direction = -direction;
    longest_s = std::max(longest_s, time_s - since_s);
  }
  return longest_s;
}

constexpr double kMasses_kg[] = {0.02, 0.1, 0.5, 2}, kWalls_n_per_m[] = {1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5};
constexpr double kDelays_s[] = {0, 0.001, 0.002, 0.003, 0.005};
// What the device may give more than it was given, for ever: docs/safety.md.
constexpr double kMostGiven_j = kForceLimit_n * 0.1;

}  // namespace

TEST_CASE("stability: no wall, mass, rate or delay makes a loop that goes on shaking") {
  const bool is_delay_known = GENERATE(true, false);  // false: a device without an echo
  int disarmed = 0, calmed = 0, loops = 0;
  for (const double rate_hz : {1000.0, 4000.0}) {
    for (const double delay_s : kDelays_s) {
      for (const double mass_kg : kMasses_kg) {
        for (const double stiffness : kWalls_n_per_m) {
          Loop loop{mass_kg, stiffness, rate_hz, delay_s};
          loop.is_delay_known = is_delay_known;
          const Seen seen = run(loop, 6, press);
          INFO("rate " << rate_hz << ", delay " << delay_s << ", mass " << mass_kg << ", wall " << stiffness << ", delay known "
                       << is_delay_known);
          CHECK(longest_swinging_s(seen, rate_hz) <= 0.3);
          CHECK(seen.given_j <= kMostGiven_j);
          ++loops;
          disarmed += seen.is_disarmed;
          calmed += seen.calmed > 0;
        }
      }
    }
  }
  CHECK(disarmed < loops / 5);
  WARN(loops << " loops, delay known " << is_delay_known << ": " << calmed << " calmed, " << disarmed << " disarmed");
}

TEST_CASE("stability: without the stage the same loops shake") {
  int shaking = 0;
  for (const double stiffness : kWalls_n_per_m) {
    Loop loop{0.1, stiffness, 1000, 0.002};
    loop.has_stage = false;
    shaking += longest_swinging_s(run(loop, 4, press), loop.rate_hz) > 1;
  }
  CHECK(shaking >= 4);
}

TEST_CASE("stability: a loop that its device bears is left alone") {
  Loop loop{0.1, 800, 1000, 0};
  loop.device_n_s_per_m = 2;
  SECTION("pressed") {
    const Seen seen = run(loop, 4, press);
    CHECK(seen.calmed == 0);
    CHECK(seen.most_damping < 0.05);
    CHECK_FALSE(seen.is_disarmed);
  }
  SECTION("tapped as fast as a hand can") {
    const Seen seen = run(loop, 5, [](double t) { return t < 1 ? 0.01 : 0.004 * std::cos(kTurn * 7 * (t - 1)); });
    CHECK(seen.calmed == 0);
    CHECK_FALSE(seen.is_disarmed);
  }
  SECTION("hit hard, so that it rings and fades") {
    loop.stiffness_n_per_m = 3000;
    loop.device_n_s_per_m = 6;
    const Seen seen = run(loop, 3, [](double t) { return t < 1 ? 0.02 : -0.01; });
    CHECK(seen.calmed == 0);
    CHECK_FALSE(seen.is_disarmed);
  }
}

TEST_CASE("stability: a texture under a hand that travels is no shaking") {
  const DeviceLimits limits = limits_of_loop();
  Stability stage;
  stage.begin({false, true, 1000}, limits, 1000);
  double last_n[3] = {};
  for (int tick = 0; tick < 5000; ++tick) {
    const double time_s = tick * 1e-3;
    const double tip_m[3] = {0.1 * time_s, 0, -0.002};
    double force_n[3] = {0, 0, 2 + 1.5 * std::sin(kTurn * 40 * time_s)};
    stage.step(tip_m, static_cast<std::uint64_t>((1 + time_s) * 1e9), last_n, 0, false, force_n);
    std::copy_n(force_n, 3, last_n);
  }
  CHECK(stage.share() == 1);
  // the same in place
  for (int tick = 5000; tick < 6000; ++tick) {
    const double time_s = tick * 1e-3;
    const double tip_m[3] = {0.5, 0, -0.002 - 1e-4 * std::sin(kTurn * 40 * time_s)};
    double force_n[3] = {0, 0, 2 + 1.5 * std::sin(kTurn * 40 * time_s)};
    stage.step(tip_m, static_cast<std::uint64_t>((1 + time_s) * 1e9), last_n, 0, false, force_n);
    std::copy_n(force_n, 3, last_n);
  }
  CHECK(stage.share() < 1);
}

// Two touches of 30 ms, each left a third faster than it was come to: bounces that feed themselves. Returns the share of the
// force after them; reports within [lost_from_s, lost_to_s) do not arrive.
double share_after_two_throws(double lost_from_s, double lost_to_s) {
  constexpr double kTouch_s = 0.03, kPeriod_s = 0.06, kSpeed_m_per_s = 0.1;
  Stability stage;
  stage.begin({true, true, 1000}, limits_of_loop(), 1000);
  const double none_n[3] = {};
  for (int tick = 0; tick < 2 * 90; ++tick) {
    const double time_s = tick * 1e-3, since_s = std::fmod(time_s, kTouch_s + kPeriod_s);
    if (time_s >= lost_from_s && time_s < lost_to_s) continue;
    double z_m = -1e-4, force_n[3] = {};
    if (since_s < kPeriod_s / 2)
      z_m = kSpeed_m_per_s * (kPeriod_s / 2 - since_s);
    else if (since_s < kPeriod_s / 2 + kTouch_s)
      force_n[2] = 1;
    else
      z_m = 1.33 * kSpeed_m_per_s * (since_s - kPeriod_s / 2 - kTouch_s);
    const double tip_m[3] = {0, 0, z_m};
    stage.step(tip_m, static_cast<std::uint64_t>((1 + time_s) * 1e9), none_n, 0, false, force_n);
  }
  return stage.share();
}

TEST_CASE("stability: a gap in the reports ends a row of bounces") {
  CHECK(share_after_two_throws(0, 0) == Approx(kCalmingShare));
  CHECK(share_after_two_throws(0.0595, 0.0605) == Approx(kCalmingShare));  // one report is no gap
  CHECK(share_after_two_throws(0.125, 0.140) == 1);                        // in the second touch
  CHECK(share_after_two_throws(0.070, 0.090) == 1);                        // in the flight before it
}

TEST_CASE("stability: the motors' mean square force comes down to what they stand") {
  DeviceLimits limits = limits_of_loop();
  limits.continuous_force_n = 1;
  limits.heat_s = 2;
  Stability stage;
  stage.begin({false, false, 0}, limits, 1000);
  const double tip_m[3] = {};
  double last_n[3] = {}, first_hot_s = -1, mean_n2 = 0;
  for (int tick = 0; tick < 20'000; ++tick) {
    double force_n[3] = {0, 0, kForceLimit_n};
    stage.step(tip_m, 1'000'000'000 + static_cast<std::uint64_t>(tick) * 1'000'000, last_n, 0, false, force_n);
    CHECK(force_n[2] <= kForceLimit_n);
    std::copy_n(force_n, 3, last_n);
    mean_n2 += (force_n[2] * force_n[2] - mean_n2) * (1 - std::exp(-1e-3 / limits.heat_s));
    if (stage.is_hot() && first_hot_s < 0) first_hot_s = tick * 1e-3;
    REQUIRE(mean_n2 <= limits.continuous_force_n * limits.continuous_force_n * 1.001);
  }
  CHECK(last_n[2] == Approx(1).epsilon(0.01));
  CHECK(first_hot_s == Approx(-2 * std::log(1 - 0.8 / 25)).epsilon(0.05));
  for (int tick = 20'000; tick < 40'000; ++tick) {  // it rests, and is as before
    double force_n[3] = {};
    stage.step(tip_m, 1'000'000'000 + static_cast<std::uint64_t>(tick) * 1'000'000, last_n, 0, false, force_n);
    std::copy_n(force_n, 3, last_n);
  }
  double force_n[3] = {0, 0, kForceLimit_n};
  stage.step(tip_m, 42'000'000'000, last_n, 0, false, force_n);
  CHECK(force_n[2] == kForceLimit_n);
}

TEST_CASE("stability: armed anew it begins anew, but motors stay warm") {
  DeviceLimits limits = limits_of_loop();
  limits.continuous_force_n = 1;
  limits.heat_s = 100;
  Stability stage;
  stage.begin({true, true, 1000}, limits, 1000);
  double last_n[3] = {};
  for (int tick = 0; tick < 5000; ++tick) {
    const double tip_m[3] = {0, 0, 1e-3 * std::sin(kTurn * 30e-3 * tick)};
    double force_n[3] = {0, 0, 3 * std::sin(kTurn * 30e-3 * tick + 1)};
    stage.step(tip_m, 1'000'000'000 + static_cast<std::uint64_t>(tick) * 1'000'000, last_n, 0, false, force_n);
    std::copy_n(force_n, 3, last_n);
  }
  REQUIRE(stage.share() < 1);
  stage.reset();
  CHECK(stage.share() == 1);
  CHECK_FALSE(stage.shakes());
  CHECK(stage.damping() == 0);
}
