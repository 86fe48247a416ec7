// SPDX-License-Identifier: Apache-2.0
// Soft fingers: the limit of torque combined with tangential force; no creep and no energy gain; a beam held by two of them.
#include <cmath>
#include <cstring>
#include <string>

#include "catch.hpp"
#include "fdcg/soft_finger.h"
#include "pile_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kStiffness = 1000, kSide = 0.1;

fdcg_scene_config with_soft_fingers() {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.has_soft_fingers = 1;
  return config;
}

// A finger that presses down on a fixed cube's upper face, and turns about any axis.
class Press {
 public:
  Press(double mu_static, double mu_dynamic, double radius_m, double depth_m)
      : rig_(fdcg_make_pile_config(), with_soft_fingers()), radius_m_(radius_m), depth_m_(depth_m) {
    object_ =
        rig_.add_fixed(rig_.box(kSide, kSide, kSide), friction(mu_static, mu_dynamic, kStiffness), posed({0, 0, -kSide / 2}));
    finger_ = rig_.scene().add({0.001, 0.002, 0.01});
    fdcg_error error;
    REQUIRE(fdcg_scene_set_finger_radius(scene(), finger_, radius_m, &error) == FDCG_OK);
    rig_.scene().step();
    at(0, 0, 0);
  }
  // Where it is sideways from where it touched first, and how far it is turned about the normal.
  void at(double x, double y, double angle_rad) {
    const fdcg_pose turn = posed({0, 0, 0}, {0, 0, 1}, angle_rad);
    fdcg_error error;
    REQUIRE(fdcg_scene_set_finger_rotation(scene(), finger_, turn.rotation_xyzw, &error) == FDCG_OK);
    rig_.scene().move(finger_, {0.001 + x, 0.002 + y, -depth_m_});
    rig_.scene().step();
  }
  [[nodiscard]] Place torque() {
    double torque[3];
    fdcg_error error;
    REQUIRE(fdcg_scene_get_finger_torque(scene(), finger_, torque, &error) == FDCG_OK);
    return place(torque);
  }
  [[nodiscard]] Place force() { return place(rig_.scene().result(finger_).force_n); }
  [[nodiscard]] bool slips() { return rig_.scene().result(finger_).touches[0].slipping != 0; }
  // As a share of what the touch bears at this coefficient: 1 on the limit surface.
  [[nodiscard]] double limit_share(double mu) {
    const double load = mu * force()[2];
    return std::hypot(force()[0] / load, force()[1] / load, torque()[2] / (load * radius_m_));
  }
  // In its springs.
  [[nodiscard]] double energy_j() {
    const double twist = torque()[2] / radius_m_;
    return (dot(force(), force()) + twist * twist) / (2 * kStiffness);
  }
  [[nodiscard]] fdcg_scene* scene() { return rig_.scene().get(); }
  [[nodiscard]] PileRig& rig() { return rig_; }
  [[nodiscard]] fdcg_object_id object() const { return object_; }

 private:
  PileRig rig_;
  double radius_m_, depth_m_;
  fdcg_object_id object_;
  fdcg_finger_id finger_;
};

double angle_for(double tangent_of_half) {
  return 2 * std::atan(tangent_of_half);
}

}  // namespace

TEST_CASE("a soft finger that is turned resists mu N a before it slips, then mu_d N a") {
  for (const double radius : {0.002, 0.01}) {
    for (const double mu : {0.1, 0.5, 1.2}) {
      for (const double depth : {0.0005, 0.002}) {
        CAPTURE(radius, mu, depth);
        const double mu_dynamic = 0.8 * mu, bears = mu * kStiffness * depth * radius;
        Press press(mu, mu_dynamic, radius, depth);
        CHECK(norm(press.torque()) == 0);
        press.at(0, 0, angle_for(0.999 * mu * depth / (2 * radius)));
        CHECK_FALSE(press.slips());
        CHECK(press.torque()[2] == Approx(-0.999 * bears).epsilon(1e-9));
        fdcg_reaction reaction;
        fdcg_scene_get_reactions(press.scene(), &reaction, 1);
        const Place arm = {0.001, 0.002, 0.05};
        CHECK(reaction.torque_n_m[2] - cross(arm, press.force() * -1.0)[2] == Approx(-press.torque()[2]).epsilon(1e-9));
        press.at(0, 0, angle_for(1.001 * mu * depth / (2 * radius)));
        CHECK(press.slips());
        CHECK(press.torque()[2] == Approx(-0.8 * bears).epsilon(1e-9));
        CHECK(press.force()[2] == Approx(kStiffness * depth));
        press.at(0, 0, 0);  // what had slipped now pushes the other way
        CHECK_FALSE(press.slips());
        CHECK(press.torque()[2] > 0);
      }
    }
  }
}

TEST_CASE("torque and tangential force share an ellipsoidal limit, at which both slip in proportion") {
  for (int degrees = 0; degrees <= 90; degrees += 10) {
    const double mu = 0.6, mu_dynamic = 0.45, radius = 0.004, depth = 0.001, c = std::cos(degrees * M_PI / 180),
                 s = std::sin(degrees * M_PI / 180);
    CAPTURE(degrees);
    Press press(mu, mu_dynamic, radius, depth);
    const auto stretch = [&](double share) {
      press.at(share * mu * depth * c * 0.6, share * mu * depth * c * 0.8, angle_for(share * mu * depth * s / (2 * radius)));
    };
    stretch(0.5);
    stretch(0.999);
    CHECK_FALSE(press.slips());
    CHECK(press.limit_share(mu) == Approx(0.999).epsilon(1e-6));
    stretch(1.001);
    CHECK(press.slips());
    CHECK(press.limit_share(mu_dynamic) == Approx(1).epsilon(1e-6));
    CHECK(norm({press.force()[0], press.force()[1], 0}) == Approx(mu_dynamic * kStiffness * depth * c).margin(1e-6));
    CHECK(std::abs(press.torque()[2]) == Approx(mu_dynamic * kStiffness * depth * radius * s).margin(1e-9));
  }
}

TEST_CASE("a soft finger on any way stays within its limit, and held still gains no energy") {
  Random random(17);
  Press press(0.5, 0.4, 0.005, 0.001);
  double x = 0, y = 0, angle = 0;
  int slipped = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    x += random.uniform(-2e-4, 2e-4), y += random.uniform(-2e-4, 2e-4), angle += random.uniform(-0.05, 0.05);
    x *= 0.999, y *= 0.999;
    press.at(x, y, angle);
    slipped += press.slips();
    REQUIRE(press.limit_share(0.5) <= 1 + 1e-9);
    if (press.slips()) REQUIRE(press.limit_share(0.4) <= 1 + 1e-9);
    const double before = press.energy_j();
    press.at(x, y, angle);
    REQUIRE(press.energy_j() <= before * (1 + 1e-12));
  }
  CHECK(slipped > 1000);
  CHECK(slipped < 19000);
}

TEST_CASE("a twist within the limit does not creep in 10^5 ticks of tremor") {
  Press press(0.5, 0.4, 0.005, 0.001);
  Random random(3);
  press.at(1e-4, 0, 0.05);
  const Place torque = press.torque(), force = press.force();
  for (int tick = 0; tick < 100000; ++tick)
    press.at(1e-4 + random.uniform(-1e-4, 1e-4), random.uniform(-1e-4, 1e-4), 0.05 + random.uniform(-0.03, 0.03));
  press.at(1e-4, 0, 0.05);
  CHECK(press.torque() == torque);
  CHECK(press.force() == force);
}

TEST_CASE("two soft fingers hold a beam off its middle up to the load of the ellipsoid's limit") {
  // pressed along x; the beam's weight pulls down and turns it about x
  const double mu = 0.5, radius = 0.006, depth = 0.002, aside = 0.004, load = kStiffness * depth;
  // its twist takes the lever down to the cosine
  double holds_kg = 0, lever = aside;
  for (int i = 0; i < 50; ++i) {
    holds_kg = 2 * mu * load / (9.80665 * std::hypot(1, lever / radius));
    lever = aside * std::cos(2 * std::atan(holds_kg * 9.80665 * lever / 2 / (2 * kStiffness * radius * radius)));
  }
  for (const double share : {0.999, 1.001}) {
    PileRig rig(fdcg_make_pile_config(), with_soft_fingers());
    fdcg_body_config config = fdcg_make_body_config();
    config.linear_damping_per_s = config.angular_damping_per_s = 30;
    config.sleep_after_s = 0;
    config.gravity_m_per_s2[2] = 0;
    const auto beam =
        rig.add_body(rig.box(0.02, 0.1, 0.02), holds_kg * share, friction(mu, mu, kStiffness), posed({0, 0, 0}), config);
    fdcg_finger_id fingers[2];
    fdcg_error error;
    for (int i = 0; i < 2; ++i) {
      fingers[i] = rig.scene().add({i == 0 ? -0.02 : 0.02, aside, 0});
      REQUIRE(fdcg_scene_set_finger_radius(rig.scene().get(), fingers[i], radius, &error) == FDCG_OK);
    }
    rig.scene().step();
    for (int i = 0; i < 2; ++i)
      rig.scene().move(fingers[i], {(i == 0 ? -1 : 1) * (0.01 - depth), aside, 0});
    rig.scene().step();
    constexpr int kLowering = 20000;
    for (int tick = 1; tick <= kLowering; ++tick) {
      rig.body(beam).config.gravity_m_per_s2[2] = -9.80665 * tick / kLowering;
      rig.tick();
    }
    rig.ticks(3000);
    const Place at = rig.centre(beam);
    rig.ticks(3000);
    CAPTURE(share, holds_kg, at[2], rig.centre(beam)[2]);
    CHECK((norm(rig.centre(beam) - at) < 1e-9) == (share < 1));
    CHECK((norm(rig.centre(beam) - at) > 1e-5) == (share > 1));
  }
}

TEST_CASE("room for soft fingers does not change other fingers, and invalid values are refused") {
  for (int soft = 0; soft < 2; ++soft) {
    static std::vector<Place> forces;
    SceneRig scene(soft == 0 ? fdcg_make_scene_config() : with_soft_fingers());
    PileRig shapes;
    const auto box = shapes.box(kSide, kSide, kSide);
    scene.add(shapes.graph(box), friction(0.5, 0.4), posed({0, 0, 0}));
    const fdcg_finger_id finger = scene.add({0, 0, 0.06}), other = scene.add({0, 0, 1});
    fdcg_error error = {};
    if (soft == 0) {
      CHECK(fdcg_scene_set_finger_radius(scene.get(), other, 0.01, &error) == FDCG_E_ARGUMENT);
      CHECK(std::string(error.message).find("has no room for soft fingers; set config.has_soft_fingers") != std::string::npos);
    } else {
      CHECK(fdcg_scene_set_finger_radius(scene.get(), other, 0.01, &error) == FDCG_OK);
      CHECK(fdcg_scene_set_finger_radius(scene.get(), other, -1, &error) == FDCG_E_ARGUMENT);
      CHECK(std::string(error.message) == "radius_m is -1, allowed 0 and 1e-9 to 1e3");
      const double twice[4] = {0, 0, 0, 2};
      CHECK(fdcg_scene_set_finger_rotation(scene.get(), other, twice, &error) == FDCG_E_ARGUMENT);
      CHECK(std::string(error.message).find("rotation_xyzw's length is 2") == 0);
    }
    for (std::size_t tick = 0; tick < 2000; ++tick) {
      const double t = 0.001 * static_cast<double>(tick);
      scene.move(finger, {0.06 * std::sin(3 * t), 0.05 * std::cos(5 * t), 0.048});
      scene.step();
      const Place force = place(scene.result(finger).force_n);
      if (soft == 0) {
        forces.push_back(force);
      } else {
        REQUIRE(force == forces[tick]);
      }
    }
  }
}
