// SPDX-License-Identifier: Apache-2.0
// Bodies on the ground, on ramps, on one another: sticking, sliding and its speed, coming to rest and staying at rest.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "pile_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kGravity = 9.80665;
constexpr double kSide = 0.04, kMass_kg = 0.05;

fdcg_body_config wakeful() {
  fdcg_body_config config = fdcg_make_body_config();
  config.sleep_after_s = 0;
  return config;
}

// A flat block on the plane z = 0; gravity leans so that +x is downhill. It lies there with its weight on: as deep as its
// springs carry it, then the hill is raised.
class Ramp {
 public:
  explicit Ramp(double mu_static, double mu_dynamic, bool is_graph = false) {
    const auto block = rig_.box(0.08, 0.08, 0.01);
    if (is_graph) {
      rig_.add_fixed(rig_.box(20, 1, 0.1), friction(mu_static, mu_dynamic), posed({0, 0, -0.05}));
    } else {
      rig_.ground({0, 0, 1}, 0, friction(mu_static, mu_dynamic));
    }
    rig_.add_body(block, kMass_kg, friction(mu_static, mu_dynamic), posed({-9, 0, 0.005}), wakeful(), 8);
    rig_.ticks(400);
  }
  // So slowly that nothing oscillates, at the end in ever smaller steps.
  void lean(double angle_rad) {
    constexpr int kLeaning = 300;
    const double from = angle_rad_;
    for (int tick = 1; tick <= kLeaning; ++tick) {
      const double share = 0.5 - 0.5 * std::cos(M_PI * tick / kLeaning);
      set(from + (angle_rad - from) * share);
      rig_.tick();
    }
    angle_rad_ = angle_rad;
  }
  void ticks(int count) { rig_.ticks(count); }
  // Of the middle of its lower side, which does not move where it only rocks.
  [[nodiscard]] double x() {
    const fdcg_pose pose = fdcg_body_get_pose(&rig_.body(0));
    const double* q = pose.rotation_xyzw;
    return pose.translation_m[0] - 2 * (q[0] * q[2] + q[1] * q[3]) * 0.005;
  }
  [[nodiscard]] double speed() { return rig_.velocity(0)[0]; }
  [[nodiscard]] PileRig& rig() { return rig_; }

 private:
  void set(double angle_rad) {
    rig_.body(0).config.gravity_m_per_s2[0] = kGravity * std::sin(angle_rad);
    rig_.body(0).config.gravity_m_per_s2[2] = -kGravity * std::cos(angle_rad);
  }

  PileRig rig_;
  double angle_rad_ = 0;
};

// Kinetic, of height, and of the springs' loads.
double energy_j(PileRig& rig) {
  double sum = 0;
  for (std::size_t i = 0; i < rig.bodies().size(); ++i) {
    const fdcg_body& body = rig.body(i);
    sum += fdcg_body_get_kinetic_energy_j(&body) + body.config.mass_kg * kGravity * rig.centre(i)[2];
  }
  for (const fdcg_pile_touch& touch : rig.touches())
    sum += touch.load_n * touch.load_n / (2 * touch.stiffness_n_per_m);
  return sum;
}

}  // namespace

TEST_CASE("a block on a ramp sticks below atan(mu) and slides above, over a grid of friction and angle") {
  constexpr int kGrid = 20;
  int stuck = 0, slid = 0;
  for (int i = 0; i < kGrid; ++i) {
    const double mu = 0.05 + 1.15 * i / (kGrid - 1);
    for (int j = 0; j <= kGrid; ++j) {
      // from nearly flat to twice the slope that it bears, closest around it
      const double away = j == 0 ? 0.001 : 0.001 * std::pow(900, double(j) / kGrid);
      for (const double side : {-1.0, 1.0}) {
        const double slope = mu * (1 + side * away);
        Ramp ramp(mu, mu);
        ramp.lean(std::atan(slope));
        ramp.ticks(400);
        const double from = ramp.x();
        ramp.ticks(200);
        const double moved = ramp.x() - from;
        CAPTURE(mu, slope, moved, ramp.speed());
        if (side < 0) {
          CHECK(std::abs(moved) < 1e-9);
          stuck += std::abs(moved) < 1e-9;
        } else {
          CHECK(moved > 1e-5);
          slid += moved > 1e-5;
        }
      }
    }
  }
  CHECK(stuck == kGrid * (kGrid + 1));
  CHECK(slid == kGrid * (kGrid + 1));
}

TEST_CASE("a block slides down a ramp at g (sin - mu_d cos)") {
  for (const bool is_graph : {false, true}) {
    double worst = 0;
    for (int i = 0; i < 20; ++i) {
      const double mu_dynamic = 0.05 + 0.95 * i / 19;
      for (int j = 0; j < 20; ++j) {
        if (is_graph && (i % 4 != 0 || j % 4 != 0)) continue;
        const double angle = std::atan(mu_dynamic * (1.15 + 0.1 * j));
        Ramp ramp(1.1 * mu_dynamic, mu_dynamic, is_graph);
        ramp.lean(angle);
        ramp.ticks(200);
        const double before = ramp.speed();
        ramp.ticks(100);
        const double expected = kGravity * (std::sin(angle) - mu_dynamic * std::cos(angle));
        const double error = std::abs((ramp.speed() - before) / 0.1 / expected - 1);
        worst = std::max(worst, error);
        CAPTURE(is_graph, mu_dynamic, angle, ramp.x(), ramp.speed());
        CHECK(error < 1e-3);
      }
    }
    WARN((is_graph ? "on a graph: " : "on the ground: ") << "worst error of the acceleration " << worst);
  }
}

TEST_CASE("a block released after a slide is pulled back by at most mu_d times its depth") {
  for (const double mu : {0.1, 0.4, 0.9}) {
    Ramp ramp(mu, mu);
    const double depth = kMass_kg * kGravity / (4 * 500);
    fdcg_body& body = ramp.rig().body(0);
    const double from = ramp.x();
    body.config.gravity_m_per_s2[0] = 3 * mu * kGravity;  // a push at the centre of mass
    ramp.ticks(300);
    body.config.gravity_m_per_s2[0] = 0;
    double farthest = ramp.x(), back = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      ramp.ticks(1);
      farthest = std::max(farthest, ramp.x());
      back = std::max(back, farthest - ramp.x());
    }
    WARN("dragged back by " << back / (mu * depth) << " of mu_d times the depth");
    CAPTURE(mu, farthest - from, back, depth);
    CHECK(farthest - from > 0.05);
    CHECK(back <= mu * depth * (1 + 1e-3));
    CHECK(back > 0.9 * mu * depth);
    CHECK(std::abs(ramp.speed()) < 1e-9);
  }
}

TEST_CASE("a box falls on the ground, does not bounce, falls asleep there and wakes when touched") {
  for (const double height : {0.001, 0.05, 0.5}) {
    for (const bool is_tilted : {false, true}) {
      PileRig rig;
      const auto cube = rig.box(kSide, kSide, kSide);
      rig.ground({0, 0, 1}, 0, friction(0.5, 0.4));
      const Place axis = {0.6, 0.8, 0};
      rig.add_body(cube, kMass_kg, friction(0.5, 0.4), posed({0, 0, kSide + height}, axis, is_tilted ? 0.3 : 0));
      double lifted = 0, lowest = 1;
      bool has_landed = false;
      for (int tick = 0; tick < 4000; ++tick) {
        rig.tick(2);
        const bool touches = !rig.touches().empty();
        has_landed = has_landed || touches;
        lowest = std::min(lowest, rig.centre(0)[2]);
        if (has_landed && !touches) lifted += 1;
      }
      CAPTURE(height, is_tilted, lowest);
      CHECK(lifted == 0);
      CHECK(rig.touches().size() == 8);
      REQUIRE(rig.body(0).is_asleep == 1);
      CHECK(rig.centre(0)[2] == Approx(kSide / 2 * (1 - 0x1p-10) - kMass_kg * kGravity / 4000).epsilon(1e-6));
      const Place at = rig.centre(0);
      const std::uint64_t steps = fdcg_pile_get_counts(rig.pile()).steps;
      rig.ticks(1000);
      CHECK(rig.centre(0) == at);
      CHECK(fdcg_pile_get_counts(rig.pile()).steps == steps);  // nothing is looked at
      const fdcg_finger_id finger = rig.scene().add(at + Place{kSide, 0, 0});
      rig.tick();
      rig.scene().move(finger, at + Place{kSide / 2 - 0.001, 0, 0});
      rig.ticks(2);
      CHECK(rig.body(0).is_asleep == 0);
    }
  }
}

TEST_CASE("boxes stacked flush and askew settle and sleep") {
  for (const double turn : {0.0, 0.3}) {
    PileRig rig;
    const auto cube = rig.box(kSide, kSide, kSide);
    rig.ground({0, 0, 1}, 0, friction(0.5, 0.4, 5000));
    constexpr int kBoxes = 5;
    for (int i = 0; i < kBoxes; ++i) {
      const double aside = turn == 0 ? 0 : 0.003 * (i % 3 - 1);
      rig.add_body(cube, kMass_kg, friction(0.5, 0.4, 5000),
                   posed({aside, -aside, kSide * (i + 0.5) + 0.001 * (i + 1)}, {0, 0, 1}, turn * i));
    }
    rig.ticks(6000, 4);
    for (int i = 0; i < kBoxes; ++i) {
      CAPTURE(turn, i, rig.velocity(i)[2], rig.body(i).quiet_s);
      CHECK(rig.body(i).is_asleep == 1);
      CHECK(rig.centre(i)[2] == Approx(kSide * (i + 0.5)).margin(0.002));
      CHECK(std::abs(rig.centre(i)[0]) < 0.004);
    }
  }
}

TEST_CASE("a stack on a tilted table does not creep, on graphs of either precision") {
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    PileRig rig;
    const fdcg_params params = friction(0.5, 0.5, 2000);
    const auto table = rig.shape(grid_box(3, 3, 1, {0.5, 0.5, 0.02}), precision);
    const auto cube = rig.shape(grid_box(1, 1, 1, {kSide, kSide, kSide}), precision);
    constexpr double kTilt_rad = 0.2;
    const auto above = [](double height) {
      return posed({0, -height * std::sin(kTilt_rad), height * std::cos(kTilt_rad)}, {1, 0, 0}, kTilt_rad);
    };
    rig.add_fixed(table, params, above(-0.01));
    for (int i = 0; i < 3; ++i)
      rig.add_body(cube, kMass_kg, params, above(0.021 + 0.041 * i), wakeful());
    rig.ticks(4000, 2);
    const Place at = rig.centre(2);
    rig.ticks(20000, 2);
    CAPTURE(norm(rig.centre(2) - at));
    CHECK(norm(rig.centre(2) - at) < 1e-12);
    CHECK(norm(at - place(above(0.1).translation_m)) < 0.004);
  }
}

TEST_CASE("a heap of various bodies thrown on a slope and the ground gains no energy, comes to rest and sleeps") {
  for (const std::uint32_t substeps : {1U, 4U}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      fdcg_pile_config config = fdcg_make_pile_config();
      config.point_capacity = config.touch_capacity = 400;
      PileRig rig(config);
      Random random(seed);
      const fdcg_params params = friction(0.6, 0.4, 2000);
      const std::size_t shapes[] = {rig.box(0.04, 0.04, 0.04),
                                    rig.box(0.12, 0.02, 0.02),
                                    rig.box(0.08, 0.08, 0.01),
                                    rig.shape(scaled(ico_sphere(2), 0.025)),
                                    rig.shape(scaled(l_prism(), 0.02)),
                                    rig.shape(scaled(spiky_sphere(2, 0.5, 3), 0.02)),
                                    rig.shape(scaled(cone(8), 0.02)),
                                    rig.shape(scaled(torus(24, 12), 0.025)),
                                    rig.shape(scaled(corner_pit(), 0.02))};
      rig.ground({0, 0, 1}, 0, params);
      rig.add_fixed(rig.box(0.3, 0.3, 0.02), params, posed({0, 0, 0.05}, {0, 1, 0}, 0.3));
      for (std::size_t i = 0; i < std::size(shapes); ++i) {
        const Place at = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.15 + 0.07 * static_cast<double>(i)};
        const auto body =
            rig.add_body(shapes[i], random.uniform(0.02, 0.1), params, posed(at, direction(random), random.uniform(0, 6)));
        const Place velocity = direction(random), spin = direction(random) * 20;
        fdcg_error error;
        REQUIRE(fdcg_body_set_motion(&rig.body(body), velocity.data(), spin.data(), &error) == FDCG_OK);
      }
      const double start = energy_j(rig);
      double most = 0, last = start;
      for (int tick = 0; tick < 6000; ++tick) {
        rig.tick(substeps);
        const double now = energy_j(rig);
        most = std::max(most, now - last);
        last = now;
      }
      CAPTURE(substeps, seed, start, last);
      CHECK(most < 2e-3 * start);  // at the start of a contact, whose spring has been pressed in by then
      CHECK(last < 0.1 * start);
      for (std::size_t i = 0; i < std::size(shapes); ++i) {
        CAPTURE(i, rig.velocity(i)[0], rig.velocity(i)[2]);
        CHECK(rig.body(i).is_asleep == 1);
        CHECK(rig.centre(i)[2] > 0.002);
      }
    }
  }
}
