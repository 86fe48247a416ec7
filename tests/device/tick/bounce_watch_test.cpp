// SPDX-License-Identifier: Apache-2.0
// Places of a ball on a surface at z = 0, without any force of its own: what counts is how fast it leaves.
#include "tick/bounce_watch.hpp"

#include <cmath>

#include "catch.hpp"

using namespace fdcg::dev;

namespace {

constexpr double kQuantum_m = 1e-5;

// Arrives at `speed`, stays inside for touch_s, leaves at `share` of it, flies for flight_s, and so on, always as fast again.
class Ball {
 public:
  double rate_hz = 1000, speed_m_per_s = 0.1, share = 1, touch_s = 0.03, flight_s = 0.06;

  // Whether the watch says so within so many touches, and (*touches) after how many.
  bool is_found(int most, int* touches, const BounceLimits& limits = kBounces) {
    BounceWatch watch;
    watch.begin(1 / rate_hz);
    fly(watch, 0.02, -speed_m_per_s, limits);
    for (*touches = 1; *touches <= most; ++*touches) {
      const double arrived_s = time_s_;
      z_m_ = -1e-4;
      while (time_s_ < arrived_s + touch_s)
        tick(watch, limits);
      z_m_ = 0;
      if (fly(watch, 0.015, share * speed_m_per_s, limits)) return true;
      if (fly(watch, flight_s - 0.03, 0, limits)) return true;
      if (fly(watch, 0.015, -speed_m_per_s, limits)) return true;
    }
    return false;
  }

 private:
  bool fly(BounceWatch& watch, double seconds, double v_m_per_s, const BounceLimits& limits) {
    z_m_ = v_m_per_s < 0 ? -v_m_per_s * seconds : std::max(z_m_, 0.0);
    bool is_found = false;
    for (const double end_s = time_s_ + seconds; time_s_ < end_s; z_m_ = std::max(z_m_ + v_m_per_s / rate_hz, 0.0))
      is_found = tick(watch, limits) || is_found;
    return is_found;
  }
  bool tick(BounceWatch& watch, const BounceLimits& limits) {
    time_s_ += 1 / rate_hz;
    const double tip_m[3] = {0.01, 0.02, std::nearbyint(z_m_ / kQuantum_m) * kQuantum_m};
    const double force_n[3] = {0, 0, z_m_ < 0 ? 1.0 : 0.0};
    return watch.step(tip_m, static_cast<std::uint64_t>((1 + time_s_) * 1e9), force_n, limits);
  }
  double time_s_ = 0, z_m_ = 0;
};

}  // namespace

TEST_CASE("bounces: a hand that leaves no faster than it came is none, one that does is found at its second throw") {
  int touches = 0;
  for (const double rate_hz : {250.0, 1000.0, 4000.0, 8000.0}) {
    for (const double speed : {0.03, 0.1, 0.5}) {
      Ball ball;
      ball.rate_hz = rate_hz;
      ball.speed_m_per_s = speed;
      INFO("rate " << rate_hz << ", speed " << speed);
      for (const double share : {0.2, 0.9, 1.0}) {
        ball.share = share;
        CHECK_FALSE(ball.is_found(20, &touches));
      }
      ball.share = 1.3;
      CHECK(ball.is_found(20, &touches));
      CHECK(touches == 2);
    }
  }
}

TEST_CASE("bounces: a long touch, or a long flight, is a hand's own doing") {
  int touches = 0;
  Ball slow;
  slow.share = 1.5;
  SECTION("touch") {
    slow.touch_s = kBounces.longest_touch_s + 0.01;
  }
  SECTION("flight") {
    slow.flight_s = kLongestFlightS + 0.01;
  }
  CHECK_FALSE(slow.is_found(20, &touches));
}

TEST_CASE("bounces: after a calming one that does not fade is enough") {
  int touches = 0;
  Ball ball;
  ball.share = 0.95;
  CHECK(ball.is_found(20, &touches, kCalmedBounces));
  CHECK(touches == 1);
  Ball fading;
  fading.share = 0.8;
  CHECK_FALSE(fading.is_found(20, &touches, kCalmedBounces));
}
