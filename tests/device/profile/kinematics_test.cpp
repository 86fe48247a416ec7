// SPDX-License-Identifier: Apache-2.0
// Each kind of kinematics: known poses, its Jacobian against differences, its inverse (found here by geometry), and what has no
// pose.
#include "profile/kinematics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "random.hpp"

namespace {

using namespace fdcg::dev;
using Axes = std::array<double, 3>;
using fdcg::test::Random;

constexpr double kPi = 3.14159265358979323846;

KinematicsParams params(KinematicsKind kind, std::vector<double> lengths_m, std::vector<double> angles_rad = {}) {
  KinematicsParams k;
  k.kind = kind;
  std::copy(lengths_m.begin(), lengths_m.end(), k.lengths_m);
  std::copy(angles_rad.begin(), angles_rad.end(), k.angles_rad);
  return k;
}

const KinematicsParams kCartesian3 = params(KinematicsKind::kCartesian, {});
const KinematicsParams kWheel = params(KinematicsKind::kRotary, {0.15});
const KinematicsParams kArm = params(KinematicsKind::kSerialArm, {0.08, 0.2, 0.18, 0.1, -0.02, 0.15});
const KinematicsParams kCoupledArm = params(KinematicsKind::kSerialArm, {0.08, 0.2, 0.18}, {1});
const KinematicsParams kDeltaRobot = params(KinematicsKind::kDelta, {0.06, 0.1, 0.2, 0.03, 0.15});
const KinematicsParams kOddDelta = params(KinematicsKind::kDelta, {0.07, 0.12, 0.22, 0.04, 0.1}, {0.2, 2.0, 4.4});

struct Case {
  const char* name;
  KinematicsParams k;
  int axis_count;
  double low, high;  // of each axis
};
const Case kCases[] = {{"cartesian", kCartesian3, 3, -0.1, 0.1},
                       {"two axes", kCartesian3, 2, -0.1, 0.1},
                       {"rotary", kWheel, 1, -4, 4},
                       {"arm", kArm, 3, -1.2, 1.2},
                       {"coupled arm", kCoupledArm, 3, -2, 2},
                       {"delta", kDeltaRobot, 3, -0.4, 0.9},
                       {"odd delta", kOddDelta, 3, -0.3, 0.8}};

TipPose pose(const KinematicsParams& k, int axis_count, const Axes& q) {
  TipPose tip;
  REQUIRE(tip_pose(k, axis_count, q.data(), &tip));
  return tip;
}

Axes random_axes(const Case& c, Random& random) {
  Axes q = {};
  for (int i = 0; i < c.axis_count; ++i)
    q[i] = random.uniform(c.low, c.high);
  return q;
}

void check_position(const KinematicsParams& k, int axis_count, const Axes& q, double x, double y, double z) {
  const TipPose tip = pose(k, axis_count, q);
  CHECK(tip.position_m[0] == Approx(x).margin(1e-15));
  CHECK(tip.position_m[1] == Approx(y).margin(1e-15));
  CHECK(tip.position_m[2] == Approx(z).margin(1e-15));
}

// The angle of one upper arm that puts the platform's centre at p: base frame turned so that the arm stands at azimuth 0.
double delta_arm_angle(const KinematicsParams& k, double azimuth, const double p[3]) {
  const double x = std::cos(azimuth) * p[0] + std::sin(azimuth) * p[1],
               y = -std::sin(azimuth) * p[0] + std::cos(azimuth) * p[1];
  const double r = x + k.lengths_m[3] - k.lengths_m[0], z = p[2];  // platform joint from the motor, in the arm's plane
  const double upper = k.lengths_m[1], lower = k.lengths_m[2];
  const double c = (r * r + z * z + y * y + upper * upper - lower * lower) / (2 * upper);  // r cos q + z sin q = c
  return std::atan2(z, r) - std::acos(c / std::hypot(r, z));                               // knee outward
}

}  // namespace

TEST_CASE("kinematics: known poses") {
  check_position(kCartesian3, 3, {0.01, -0.02, 0.03}, 0.01, -0.02, 0.03);
  check_position(kCartesian3, 1, {0.01, 9, 9}, 0.01, 0, 0);
  check_position(kWheel, 1, {0, 0, 0}, 0.15, 0, 0);
  check_position(kWheel, 1, {kPi / 2, 0, 0}, 0, 0.15, 0);
  check_position(kArm, 3, {0, 0, kPi / 2}, 0.18 - 0.1, 0.02, 0.28 - 0.15);  // upper link upright, forearm level
  check_position(kArm, 3, {kPi / 2, 0, kPi / 2}, -0.1, 0.18 + 0.02, 0.28 - 0.15);
  check_position(kArm, 3, {0, kPi / 2, kPi / 2}, 0.38 - 0.1, 0.02, 0.08 - 0.15);
  check_position(kCoupledArm, 3, {0, kPi / 2, 0}, 0.38, 0, 0.08);  // stretched forward
  check_position(kCoupledArm, 3, {0, 0, kPi / 2}, 0.18, 0, 0.28);
  // arms straight out: a knee at 0.16, the platform's joint at 0.03, so the tip is below by a leg of 0.13 and 0.2
  check_position(kDeltaRobot, 3, {0, 0, 0}, 0, 0, std::sqrt(0.2 * 0.2 - 0.13 * 0.13) - 0.15);
  // straight down: the knees at 0.06 and 0.1 down
  check_position(kDeltaRobot, 3, {kPi / 2, kPi / 2, kPi / 2}, 0, 0, 0.1 + std::sqrt(0.2 * 0.2 - 0.03 * 0.03) - 0.15);
}

TEST_CASE("kinematics: a delta with reversed arm order has the same side") {
  const KinematicsParams there = params(KinematicsKind::kDelta, {0.06, 0.1, 0.2, 0.03, 0}, {0, 2 * kPi / 3, 4 * kPi / 3});
  const KinematicsParams back = params(KinematicsKind::kDelta, {0.06, 0.1, 0.2, 0.03, 0}, {0, 4 * kPi / 3, 2 * kPi / 3});
  const TipPose one = pose(there, 3, {0.1, 0.3, -0.2}), other = pose(back, 3, {0.1, -0.2, 0.3});
  CHECK(one.position_m[2] > 0.1);
  for (int i = 0; i < 3; ++i) {
    CHECK(std::fabs(one.position_m[i] - other.position_m[i]) < 1e-15);
    CHECK(one.jacobian[i][1] == Approx(other.jacobian[i][2]));
  }
}

TEST_CASE("kinematics: the Jacobian equals finite differences") {
  Random random(61);
  for (const Case& c : kCases)
    for (int round = 0; round < 300; ++round) {
      const Axes q = random_axes(c, random);
      const TipPose tip = pose(c.k, c.axis_count, q);
      for (int j = 0; j < kMaxAxes; ++j) {
        constexpr double kStep = 1e-5;  // its square is the error, its inverse times 1e-16 the noise: both below 1e-9
        Axes more = q, less = q;
        if (j < c.axis_count) more[j] += kStep, less[j] -= kStep;
        const TipPose after = pose(c.k, c.axis_count, more), before = pose(c.k, c.axis_count, less);
        for (int i = 0; i < 3; ++i) {
          INFO(c.name << " round " << round << " d " << i << " / d " << j);
          CHECK(tip.jacobian[i][j] ==
                Approx((after.position_m[i] - before.position_m[i]) / (2 * kStep)).epsilon(1e-6).margin(1e-8));
        }
      }
    }
}

// Virtual work: in a small motion effort . dq = force . dx, to second order.
TEST_CASE("kinematics: efforts do the work of the force") {
  Random random(62);
  for (const Case& c : kCases)
    for (int round = 0; round < 300; ++round) {
      const Axes q = random_axes(c, random);
      Axes step = {};
      for (int j = 0; j < c.axis_count; ++j)
        step[j] = random.uniform(-1e-4, 1e-4);
      const double force[3] = {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
      Axes before = q, after = q;
      for (int j = 0; j < 3; ++j)
        before[j] -= step[j] / 2, after[j] += step[j] / 2;
      const TipPose tip = pose(c.k, c.axis_count, q), from = pose(c.k, c.axis_count, before),
                    to = pose(c.k, c.axis_count, after);
      double motors = 0, hand = 0;
      for (int i = 0; i < 3; ++i) {
        hand += force[i] * (to.position_m[i] - from.position_m[i]);
        for (int j = 0; j < 3; ++j)
          motors += force[i] * tip.jacobian[i][j] * step[j];
      }
      INFO(c.name << " round " << round);
      CHECK(motors == Approx(hand).margin(1e-11));
    }
}

TEST_CASE("kinematics: the inverse closes the loop") {
  Random random(63);
  SECTION("arm") {
    for (const KinematicsParams* k : {&kArm, &kCoupledArm})
      for (int round = 0; round < 1000; ++round) {
        const double b = k->lengths_m[1], c = k->lengths_m[2];
        const Axes q = {random.uniform(-1.5, 1.5), random.uniform(-0.5, 0.6), random.uniform(0.7, 2.2)};
        const TipPose tip = pose(*k, 3, q);
        const double x = tip.position_m[0] + k->lengths_m[3], y = tip.position_m[1] + k->lengths_m[4];
        const double s = std::hypot(x, y), h = tip.position_m[2] + k->lengths_m[5] - k->lengths_m[0];
        const double d2 = s * s + h * h;
        const double shoulder = std::atan2(s, h) - std::acos((b * b + d2 - c * c) / (2 * b * std::sqrt(d2)));
        const double elbow = std::atan2(s - b * std::sin(shoulder), h - b * std::cos(shoulder));
        const Axes back = {std::atan2(y, x), shoulder, elbow - k->angles_rad[0] * shoulder};
        const TipPose again = pose(*k, 3, back);
        for (int i = 0; i < 3; ++i)
          CHECK(std::fabs(again.position_m[i] - tip.position_m[i]) < 1e-12);
        if (s > 0.05)  // in front of the yaw axis the angles are those that we began with
          for (int i = 0; i < 3; ++i)
            CHECK(std::fabs(back[i] - q[i]) < 1e-9);
      }
  }
  SECTION("delta") {
    for (const KinematicsParams* k : {&kDeltaRobot, &kOddDelta})
      for (int round = 0; round < 1000; ++round) {
        const Axes q = {random.uniform(-0.4, 0.8), random.uniform(-0.4, 0.8), random.uniform(-0.4, 0.8)};
        const TipPose tip = pose(*k, 3, q);
        const double p[3] = {tip.position_m[0], tip.position_m[1], tip.position_m[2] + k->lengths_m[4]};
        Axes back;
        for (int i = 0; i < 3; ++i)
          back[i] = delta_arm_angle(*k, k == &kOddDelta ? k->angles_rad[i] : i * 2 * kPi / 3, p);
        const TipPose again = pose(*k, 3, back);
        for (int i = 0; i < 3; ++i) {
          CHECK(std::fabs(back[i] - q[i]) < 1e-9);
          CHECK(std::fabs(again.position_m[i] - tip.position_m[i]) < 1e-12);
        }
      }
  }
}

TEST_CASE("kinematics: unreachable positions are refused") {
  TipPose tip;
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const Case& c : kCases)
    for (const double bad : {nan, infinity, -infinity})
      for (int i = 0; i < c.axis_count; ++i) {
        Axes q = {};
        q[i] = bad;
        INFO(c.name << " axis " << i);
        CHECK_FALSE(tip_pose(c.k, c.axis_count, q.data(), &tip));
      }
  const Axes zero = {};
  SECTION("an axis that is not used may be anything") {
    const Axes q = {0, nan, nan};
    CHECK(tip_pose(kWheel, 1, q.data(), &tip));
  }
  SECTION("a delta out of reach") {
    const KinematicsParams wide = params(KinematicsKind::kDelta, {0.2, 0.1, 0.15, 0.03});
    CHECK_FALSE(tip_pose(wide, 3, zero.data(), &tip));  // the knees at 0.3 - 0.03, legs of 0.15
    const Axes apart = {-1.5, 1.5, -1.5};
    CHECK_FALSE(tip_pose(params(KinematicsKind::kDelta, {0.06, 0.3, 0.2, 0.03}), 3, apart.data(), &tip));
  }
  SECTION("a delta stretched flat: no effort holds it") {
    CHECK_FALSE(tip_pose(params(KinematicsKind::kDelta, {0.06, 0.1, 0.13, 0.03}), 3, zero.data(), &tip));
    CHECK_FALSE(tip_pose(params(KinematicsKind::kDelta, {0.06, 0.1, 0.13 * (1 + 2e-14), 0.03}), 3, zero.data(), &tip));
    CHECK(tip_pose(params(KinematicsKind::kDelta, {0.06, 0.1, 0.13 * (1 + 1e-10), 0.03}), 3, zero.data(), &tip));
  }
  SECTION("a delta whose arms stand in one place") {
    CHECK_FALSE(tip_pose(params(KinematicsKind::kDelta, {0.06, 0.1, 0.2, 0.03}, {1, 1, 1}), 3, zero.data(), &tip));
  }
  SECTION("parameters that are no lengths") {
    CHECK_FALSE(tip_pose(params(KinematicsKind::kRotary, {}), 1, zero.data(), &tip));
    CHECK_FALSE(tip_pose(params(KinematicsKind::kRotary, {nan}), 1, zero.data(), &tip));
    CHECK_FALSE(tip_pose(params(KinematicsKind::kRotary, {infinity}), 1, zero.data(), &tip));
    CHECK_FALSE(tip_pose(params(KinematicsKind::kSerialArm, {0.1, 0, 0.1}), 3, zero.data(), &tip));
    CHECK_FALSE(tip_pose(params(KinematicsKind::kSerialArm, {0.1, 0.1, 0.1, nan}), 3, zero.data(), &tip));
    CHECK_FALSE(tip_pose(params(KinematicsKind::kDelta, {0.06, 0.1, -0.2, 0.03}), 3, zero.data(), &tip));
  }
  SECTION("a number of axes that the kind does not have") {
    CHECK_FALSE(tip_pose(kCartesian3, 0, zero.data(), &tip));
    CHECK_FALSE(tip_pose(kCartesian3, 4, zero.data(), &tip));
    CHECK_FALSE(tip_pose(kWheel, 2, zero.data(), &tip));
    CHECK_FALSE(tip_pose(kArm, 2, zero.data(), &tip));
    CHECK_FALSE(tip_pose(kDeltaRobot, 1, zero.data(), &tip));
  }
}
