// SPDX-License-Identifier: Apache-2.0
// Bodies in a scene: fingers that hold, swing and let go of a cube.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "compiled.hpp"
#include "fdcg/body.h"
#include "meshes.hpp"
#include "scene_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kSide = 0.04, kTick = 1e-3, kGravity = 9.80665;
constexpr double kAbove = 0.002;  // the fingers grip so far above the centre, so that the cube hangs and does not topple

// A cube of 4 cm and 50 g between two fingers that press along x; what is down may lean by an angle about x.
class Grip {
 public:
  Grip(double mu, double deep_m, double mass_kg = 0.05, double lean_rad = 0)
      : compiled_(compile_whole(cube(), options(mass_kg))),
        rig_(fdcg_make_scene_config()),
        deep_(deep_m),
        up_{0, -std::sin(lean_rad), std::cos(lean_rad)} {
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled_.bytes.data(), compiled_.bytes.size(), FDCG_VERIFY_FULL, &graph_, &error) == FDCG_OK);
    fdcg_params params = fdcg_make_params();
    params.mu_static = params.mu_dynamic = mu;
    const fdcg_pose pose = fdcg_make_identity_pose();
    body_.object = rig_.add(graph_, params, pose);
    fdcg_mass mass;
    REQUIRE(fdcg_get_mass(&graph_, &mass, &error) == FDCG_OK);
    fdcg_body_config config = fdcg_make_body_config();
    config.linear_damping_per_s = config.angular_damping_per_s = 20;
    config.sleep_after_s = 0;
    for (int k = 0; k < 3; ++k)
      config.gravity_m_per_s2[k] = -kGravity * up_[static_cast<std::size_t>(k)];
    REQUIRE(fdcg_body_set_mass(&config, &mass, 0, 1, &error) == FDCG_OK);
    REQUIRE(fdcg_body_init(&body_.body, &config, &pose, &error) == FDCG_OK);
    for (int i = 0; i < 2; ++i)
      finger_[i] = rig_.add({sign(i) * kSide, kAbove * up_[1], kAbove * up_[2]});
    rig_.step();
    move({0, 0, 0});
    rig_.step();  // closed while the cube is held still
  }

  // Both fingers, from where they closed; turned about y, then moved.
  void move(const Place& by, double turn_rad = 0) {
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    for (int i = 0; i < 2; ++i) {
      const double x = sign(i) * (kSide / 2 - deep_), y = kAbove * up_[1], z = kAbove * up_[2];
      rig_.move(finger_[i], {x * c + z * s + by[0], y + by[1], z * c - x * s + by[2]});
    }
  }
  void tick(std::uint32_t substeps = 1) {
    fdcg_error error;
    fdcg_reaction reaction;
    const fdcg_status status = fdcg_scene_step_bodies(rig_.get(), &body_, 1, substeps, kTick, &reaction, 1, &error);
    if (status != FDCG_OK) FAIL(error.message);
  }
  void settle() {
    for (int i = 0; i < 20000; ++i)
      tick();
  }
  // The cube's corner that is farthest from the fingers, so that turning shows as well.
  [[nodiscard]] Place corner() const {
    const fdcg_pose pose = fdcg_body_get_pose(&body_.body);
    const Place along = turned_corner(pose);
    return {along[0] + pose.translation_m[0], along[1] + pose.translation_m[1], along[2] + pose.translation_m[2]};
  }
  // The distance of its centre below its position when gripped.
  [[nodiscard]] double sunk() const { return -(body_.body.centre_m[1] * up_[1] + body_.body.centre_m[2] * up_[2]); }
  void pull(double gravity) {
    for (int k = 0; k < 3; ++k)
      body_.body.config.gravity_m_per_s2[k] = -gravity * up_[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] fdcg_body& body() { return body_.body; }
  [[nodiscard]] std::uint32_t touches(int i) { return rig_.result(finger_[i]).touch_count; }

 private:
  static double sign(int i) { return i == 0 ? -1 : 1; }
  static bake::CompileOptions options(double mass_kg) {
    bake::CompileOptions options;
    options.metres_per_unit = kSide;
    options.mass_kg = mass_kg;
    return options;
  }
  static Place turned_corner(const fdcg_pose& pose) {
    const double x = pose.rotation_xyzw[0], y = pose.rotation_xyzw[1], z = pose.rotation_xyzw[2], w = pose.rotation_xyzw[3];
    const double v[3] = {kSide / 2, kSide / 2, -kSide / 2};
    return {(1 - 2 * (y * y + z * z)) * v[0] + 2 * (x * y - z * w) * v[1] + 2 * (x * z + y * w) * v[2],
            2 * (x * y + z * w) * v[0] + (1 - 2 * (x * x + z * z)) * v[1] + 2 * (y * z - x * w) * v[2],
            2 * (x * z - y * w) * v[0] + 2 * (y * z + x * w) * v[1] + (1 - 2 * (x * x + y * y)) * v[2]};
  }

  bake::Compiled compiled_;
  fdcg_graph graph_{};
  SceneRig rig_;
  double deep_;
  Place up_;
  fdcg_scene_body body_{};
  fdcg_finger_id finger_[2]{};
};

double distance(const Place& a, const Place& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("two fingers hold a cube under gravity for 10^6 ticks, and it does not creep") {
  Grip grip(0.6, 0.001);
  grip.settle();
  const Place start = grip.corner();
  CHECK(start[2] == Approx(-kSide / 2 - 0.05 * kGravity / 2000).epsilon(1e-6));  // as far as two springs of 1 N/mm sag
  double worst = 0;
  for (int tick = 0; tick < 1000000; ++tick) {
    grip.tick();
    worst = std::max(worst, distance(grip.corner(), start));
  }
  WARN("moved by at most " << worst << " m");
  CHECK(worst < 1e-9);
}

TEST_CASE("a cube in a gripper that swings and turns for 10^6 ticks has the same relative pose in every period") {
  Grip grip(0.6, 0.001);
  grip.settle();
  constexpr int kPeriod = 1000, kPeriods = 1000, kFirst = 5;  // until it swings alike
  std::vector<Place> places;
  double worst = 0, farthest = 0;
  for (int tick = 0; tick < kPeriod * kPeriods; ++tick) {
    const int phase = tick % kPeriod;
    const double t = 2 * M_PI * phase / kPeriod, begin = std::min(1.0, 1e-3 * tick);  // from rest
    grip.move({0.02 * begin * std::sin(2 * t), 0.01 * begin * std::sin(t), 0.015 * begin * std::sin(3 * t)},
              0.4 * begin * std::sin(t));
    grip.tick();
    if (phase % 50 != 0) continue;
    const std::size_t sample = static_cast<std::size_t>(phase / 50);
    if (tick < kPeriod * kFirst) continue;
    if (places.size() == sample) places.push_back(grip.corner());
    worst = std::max(worst, distance(grip.corner(), places[sample]));
    farthest = std::max(farthest, distance(grip.corner(), places[0]));
  }
  WARN("moved by at most " << worst << " m, swung by " << farthest << " m");
  CHECK(farthest > 0.02);
  CHECK(worst < 1e-9);
}

TEST_CASE("a cube swung about by its fingers for 10^6 ticks comes back to where it was held") {
  Grip grip(0.6, 0.001);
  grip.settle();
  const Place start = grip.corner();
  double farthest = 0;
  for (int tick = 0; tick < 1000000; ++tick) {
    const double t = tick * kTick, fade = std::min({1.0, t, (1000 - t) / 2});
    grip.move({0.002 * fade * std::sin(13 * t), 0.001 * fade * std::sin(7 * t), 0.0015 * fade * std::sin(11 * t)});
    grip.tick();
    farthest = std::max(farthest, distance(grip.corner(), start));
  }
  CHECK(farthest > 0.002);  // it was swung
  grip.move({0, 0, 0});
  grip.settle();
  WARN("came back to " << distance(grip.corner(), start) << " m");
  CHECK(distance(grip.corner(), start) < 1e-9);
}

TEST_CASE("a cube slips from two fingers exactly when it weighs more than friction holds: friction, direction and grip") {
  for (const double mu : {0.1, 0.3, 0.6, 1.0}) {
    for (const double lean_rad : {0.0, 0.4, 0.785, 1.571}) {
      for (const double deep : {0.0005, 0.001, 0.002}) {
        const double holds_kg = 2 * mu * 1000 * deep / kGravity;
        for (const double share : {0.999, 1.001}) {
          CAPTURE(mu, lean_rad, deep, share);
          Grip grip(mu, deep, holds_kg * share, lean_rad);
          // loaded as slowly as it is damped: no overshoot
          constexpr int kLowering = 20000;
          for (int tick = 0; tick < kLowering; ++tick) {
            grip.pull(kGravity * (tick + 1) / kLowering);
            grip.tick();
          }
          for (int tick = 0; tick < 8000; ++tick)
            grip.tick();
          const bool fell = grip.sunk() > 1.5 * mu * deep;
          CHECK(fell == (share > 1));
        }
      }
    }
  }
}

TEST_CASE("a released cube falls freely and gives no force") {
  Grip grip(0.6, 0.001);
  grip.settle();
  const double from = grip.corner()[2];
  grip.body().config.linear_damping_per_s = 0;
  fdcg_error error;
  const double still[3] = {0, 0, 0};
  REQUIRE(fdcg_body_set_motion(&grip.body(), still, still, &error) == FDCG_OK);
  grip.move({0, 10 * kSide, 0});
  for (int tick = 0; tick < 100; ++tick)
    grip.tick(4);
  CHECK(grip.touches(0) + grip.touches(1) == 0);
  CHECK(grip.corner()[2] == Approx(from - kGravity * 0.1 * 0.1 / 2).epsilon(1e-2));
}

TEST_CASE("a held cube falls asleep, keeps every bit, and wakes when the fingers move") {
  Grip grip(0.6, 0.001);
  grip.body().config.sleep_after_s = 0.5;
  grip.settle();
  REQUIRE(grip.body().is_asleep == 1);
  const Place at = grip.corner();
  for (int tick = 0; tick < 1000; ++tick)
    grip.tick();
  CHECK(grip.corner() == at);
  grip.move({0, 0, 0.0002});
  grip.tick();
  CHECK(grip.body().is_asleep == 0);
  grip.settle();
  CHECK(grip.corner()[2] - at[2] == Approx(0.0002).epsilon(0.01));
}

TEST_CASE("a tick with invalid bodies is refused by name") {
  Grip grip(0.6, 0.001);
  SceneRig rig(fdcg_make_scene_config());
  fdcg_scene_body body{};
  fdcg_reaction reaction;
  fdcg_error error = {};
  CHECK(fdcg_scene_step_bodies(rig.get(), &body, 1, 0, kTick, &reaction, 1, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("substeps is 0, allowed 1 to 64") == 0);
  CHECK(fdcg_scene_step_bodies(rig.get(), &body, 1, 1, kTick, &reaction, 0, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("body 0: its object has index 0") == 0);
  CHECK(fdcg_scene_step_bodies(nullptr, &body, 1, 1, kTick, &reaction, 1, &error) == FDCG_E_ARGUMENT);
  for (const double tick_s : {std::numeric_limits<double>::quiet_NaN(), 0.0, -1.0, 100.0}) {
    CHECK(fdcg_scene_step_bodies(rig.get(), &body, 1, 1, tick_s, &reaction, 1, &error) == FDCG_E_ARGUMENT);
    CHECK(std::string(error.message).find("allowed for each of the substeps 1e-9 to 1 s") != std::string::npos);
  }
  CHECK(fdcg_scene_step_bodies(rig.get(), &body, 1, 1, kTick, &reaction, 1, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message) == "body 0: has no mass; make it with fdcg_body_init");
  body.body = grip.body();
  CHECK(fdcg_scene_step_bodies(rig.get(), &body, 1, 1, kTick, &reaction, 1, &error) == FDCG_E_ARGUMENT);  // names no object
  CHECK(fdcg_scene_step_bodies(rig.get(), nullptr, 0, 1, kTick, nullptr, 0, &error) == FDCG_OK);
  CHECK(fdcg_scene_step_bodies(rig.get(), nullptr, 0, 65, kTick, nullptr, 0, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("substeps is 65, allowed 1 to 64; a shorter tick") == 0);
}
