// SPDX-License-Identifier: Apache-2.0
// The loop of a held device on walls that are known by formula, and what is said of it.
#include "hand_loop.hpp"

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "hand_metrics.hpp"
#include "linear_limit.hpp"

using namespace fdcg::test;

namespace {

// A wall over z < 0, its answer some ticks late.
class PlaneWall : public Contender {
 public:
  explicit PlaneWall(std::size_t delay = 0) : delay_(delay) { reset(); }
  void reset() override { under_way_.assign(delay_ + 1, 0); }
  void step(const Ground::Point& hip_m, Feel& feel) override {
    under_way_.push_back(std::max(0.0, -hip_m[2]) * kStiffness_n_per_m);
    under_way_.erase(under_way_.begin());
    feel = {};
    feel.in_contact = hip_m[2] < 0;
    feel.god_object = {hip_m[0], hip_m[1], std::max(0.0, hip_m[2])};
    feel.force = {0, 0, under_way_.front()};
  }

 private:
  std::size_t delay_;
  std::vector<double> under_way_;
};

std::vector<Point> still(const Point& from, const Point& to, std::size_t ticks) {
  std::vector<Point> targets(ticks, to);
  targets[0] = from;
  return targets;
}

}  // namespace

TEST_CASE("in free space the device comes to its target, and the hand feels nothing there") {
  PlaneWall wall;
  const std::vector<HandTick> ticks = run_hand(wall, still({0, 0, 0.1}, {0.01, -0.02, 0.05}, 3000), {});
  const HandTick& last = ticks.back();
  CHECK_FALSE(last.in_contact);
  CHECK(last.device_m[0] == Approx(0.01));
  CHECK(last.device_m[1] == Approx(-0.02));
  CHECK(last.device_m[2] == Approx(0.05));
  CHECK(std::hypot(last.hand_n[0], last.hand_n[1], last.hand_n[2]) < 1e-9);
}

TEST_CASE("on a wall the hand feels what its spring and the wall's in series give") {
  PlaneWall wall;
  const HandSetup setup;
  constexpr double kUnder_m = 7e-3;
  const std::vector<HandTick> ticks = run_hand(wall, still({0, 0, 0.01}, {0, 0, -kUnder_m}, 5000), setup);
  const double both = setup.hand_n_per_m * kStiffness_n_per_m / (setup.hand_n_per_m + kStiffness_n_per_m);
  CHECK(ticks.back().hand_n[2] == Approx(both * kUnder_m));
  CHECK(ticks.back().contact_n[2] == Approx(both * kUnder_m));
}

TEST_CASE("the stiffest stable wall is the eigenvalues', and delay takes from it as they say") {
  const HandSetup setup;
  const Hold hold = {{0.001, 0.002, 5e-3}, {0.001, 0.002, -5e-3}};
  const double exact = exact_limit_n_per_m({setup.axis(), setup.rate_hz, 0, 0, 0});
  for (const int delay : {0, 1, 2}) {
    PlaneWall wall(static_cast<std::size_t>(delay));
    const double late = exact_limit_n_per_m({setup.axis(), setup.rate_hz, delay, 0, 0});
    CHECK(stable_share(wall, hold, setup, exact) * exact == Approx(late).epsilon(0.01));
  }
}

TEST_CASE("what is never in contact is not stable") {
  PlaneWall wall;
  CHECK(stable_share(wall, {{0, 0, 2}, {0, 0, 1}}, {}, 1000) == 0);
}

TEST_CASE("a loop beside itself differs in nothing; what is added to the force is told by size, time and direction") {
  PlaneWall wall;
  constexpr std::size_t kTicks = 2000, kFrom = 1500, kFelt = 40;
  const std::vector<HandTick> truth = run_hand(wall, still({0, 0, 0.01}, {0, 0, -7e-3}, kTicks), {});
  const HandMetrics same = judge_hand(truth, truth, 1000, 1800, kTicks);
  CHECK(same.rms_n == 0);
  CHECK(same.vibration_n == 0);
  CHECK(same.felt_share == 0);
  CHECK(same.direction_p99_deg == 0);
  CHECK(same.held_swing_m < 1e-6);
  std::vector<HandTick> ticks = truth;
  for (std::size_t i = kFrom; i < kFrom + kFelt; ++i)
    ticks[i].hand_n[0] += truth[i].hand_n[2];  // of the true one's size, at right angles
  for (std::size_t i = kFrom + 100; i < kFrom + 200; ++i)
    ticks[i].hand_n[0] += kLeastFelt_n / 2, ticks[i].in_contact = false;
  const HandMetrics off = judge_hand(ticks, truth, 1000, 1800, kTicks);
  CHECK(off.max_n == Approx(truth[kFrom].hand_n[2]).epsilon(1e-3));
  CHECK(off.felt_ms == Approx(kFelt));
  CHECK(off.felt_share == Approx(double{kFelt} / kTicks));
  CHECK(off.direction_p99_deg > 1);
  CHECK(off.direction_p99_deg < 46);
  CHECK(off.lost_share == Approx(100.0 / static_cast<double>(std::count_if(truth.begin(), truth.end(),
                                                                           [](const HandTick& t) { return t.in_contact; }))));
  CHECK(off.vibration_n > 1e-3);
}
