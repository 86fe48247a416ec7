// SPDX-License-Identifier: Apache-2.0
// Piles under strain: stacks for long, heavy bodies on light ones, fast impacts, stiff grips, forces of the caller's.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "pile_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kSide = 0.04, kMass_kg = 0.05, kGravity = 9.80665;

fdcg_body_config weightless() {
  fdcg_body_config config = fdcg_make_body_config();
  config.gravity_m_per_s2[2] = 0;
  config.sleep_after_s = 0;
  return config;
}

std::uint32_t advised(PileRig& rig) {
  const auto count = static_cast<std::uint32_t>(rig.bodies().size());
  return fdcg_pile_get_substeps(rig.pile(), rig.scene().get(), rig.bodies().data(), count, 1e-3);
}

// Touches are softened, and how often, at this many substeps.
std::uint64_t softened(PileRig& rig, int ticks, std::uint32_t substeps) {
  const std::uint64_t before = fdcg_pile_get_counts(rig.pile()).softened_steps;
  rig.ticks(ticks, substeps);
  return fdcg_pile_get_counts(rig.pile()).softened_steps - before;
}

}  // namespace

TEST_CASE("a heavy block on a light one sinks as deep as its springs say, at the substeps advised, and is told of below") {
  const auto sunk = [](std::uint32_t substeps, bool is_advised, std::uint64_t* told) {
    PileRig rig;
    const auto params = friction(0.5, 0.5, 20000);  // 10 kN/m between two of them
    const auto cube = rig.box(kSide, kSide, kSide);
    rig.ground({0, 0, 1}, 0, params);
    rig.add_body(cube, 0.02, params, posed({0, 0, kSide / 2}));
    rig.add_body(cube, 2, params, posed({0, 0, 1.5 * kSide}));
    if (is_advised) {
      substeps = advised(rig);
      REQUIRE(substeps > 1);
    }
    *told = softened(rig, 4000, substeps);
    bool is_flagged = false;
    for (const fdcg_pile_touch& touch : rig.touches())
      is_flagged = is_flagged || touch.softened != 0;
    CHECK(is_flagged == (*told > 0));
    return 1.5 * kSide - rig.centre(1)[2];
  };
  std::uint64_t told = 0;
  CHECK(sunk(1, false, &told) > 0.004);
  CHECK(told > 1000);
  // eight points of each block press on the other, eight on the ground, by springs of 10 kN/m, each drawn in a little
  const double expected = 2 * kGravity / 16e4 + 2.02 * kGravity / 8e4 + 2 * kSide / 2 * 0x1p-10;
  CHECK(sunk(0, true, &told) == Approx(expected).epsilon(1e-3));
  CHECK(told == 0);
}

TEST_CASE("stacks of ten boxes flush and five askew stand for 10^5 ticks at the substeps advised") {
  for (const int boxes : {10, 5}) {
    PileRig rig([] {
      fdcg_pile_config config = fdcg_make_pile_config();
      config.point_capacity = config.touch_capacity = 600;
      return config;
    }());
    const auto params = friction(0.5, 0.4, 5000);
    const auto cube = rig.box(kSide, kSide, kSide);
    rig.ground({0, 0, 1}, 0, params);
    fdcg_body_config wakeful = fdcg_make_body_config();
    wakeful.sleep_after_s = 0;
    for (int i = 0; i < boxes; ++i) {
      const double aside = boxes == 5 ? 0.001 * (i % 2) : 0;
      rig.add_body(cube, kMass_kg, params, posed({aside, 0, kSide * (i + 0.5)}), wakeful);
    }
    const std::uint32_t substeps = advised(rig);
    REQUIRE(substeps > 0);
    rig.ticks(5000, substeps);
    const Place top = rig.centre(std::size_t(boxes) - 1);
    for (int block = 0; block < 95; ++block)
      rig.ticks(1000, substeps);
    CAPTURE(boxes, substeps, norm(rig.centre(std::size_t(boxes) - 1) - top));
    for (int i = 0; i < boxes; ++i) {
      CAPTURE(i);
      CHECK(std::abs(rig.centre(std::size_t(i))[2] - kSide * (i + 0.5)) < 0.1 * kSide);
      CHECK(std::abs(rig.centre(std::size_t(i))[0]) < 0.002);
      CHECK(std::abs(rig.centre(std::size_t(i))[1]) < 0.001);
    }
    CHECK(norm(rig.centre(std::size_t(boxes) - 1) - top) < 1e-4);
  }
}

TEST_CASE("boxes that meet at up to 20 m/s do not pass through one another nor gain energy") {
  for (const double speed : {1.0, 5.0, 20.0}) {
    for (const std::uint32_t substeps : {1U, 4U}) {
      for (int run = 0; run < 10; ++run) {
        PileRig rig;
        Random random(static_cast<std::uint64_t>(run) + 77);
        const auto cube = rig.box(kSide, kSide, kSide), plate = rig.box(0.01, 0.08, 0.08);
        const auto params = friction(0.5, 0.4, 2000);
        const double turn = run < 2 ? 0 : random.uniform(0, 6), way = 0.1;
        const Place axis = direction(random);
        rig.add_body(cube, kMass_kg, params, posed({-way, 0.0006 * run, 0}, axis, turn), weightless());
        rig.add_body(run % 2 == 0 ? cube : plate, kMass_kg, params, posed({way, 0, 0.0004 * run}), weightless());
        fdcg_error error;
        const double still[3] = {0, 0, 0}, right[3] = {speed / 2, 0, 0}, left[3] = {-speed / 2, 0, 0};
        REQUIRE(fdcg_body_set_motion(&rig.body(0), right, still, &error) == FDCG_OK);
        REQUIRE(fdcg_body_set_motion(&rig.body(1), left, still, &error) == FDCG_OK);
        const auto energy = [&rig] {
          return fdcg_body_get_kinetic_energy_j(&rig.body(0)) + fdcg_body_get_kinetic_energy_j(&rig.body(1));
        };
        const double start = energy();
        double least_gap = 2 * way, most = 0;
        for (int tick = 0; tick < static_cast<int>(400 / speed) + 100; ++tick) {
          rig.tick(substeps);
          least_gap = std::min(least_gap, rig.centre(1)[0] - rig.centre(0)[0]);
          most = std::max(most, energy());
        }
        CAPTURE(speed, substeps, run, least_gap, most / start);
        CHECK(least_gap > 0);
        CHECK(most <= start * (1 + 1e-9));
      }
    }
  }
}

TEST_CASE("a light cube that stiff fingers hold by friction follows them, in substeps") {
  PileRig rig;
  const auto params = friction(0.8, 0.8, 20000);
  const auto cube = rig.box(0.01, 0.01, 0.01);
  rig.add_body(cube, 0.001, params, posed({0, 0, 0}));
  const fdcg_finger_id left = rig.scene().add({-0.02, 0, 0}), right = rig.scene().add({0.02, 0, 0});
  rig.body(0).config.gravity_m_per_s2[2] = 0;
  const double depth = 0.0001;  // 2 N each: friction would bear 3.2 N
  for (int tick = 0; tick < 200; ++tick) {
    const double x = std::max(0.005 - depth, 0.02 - 0.0001 * tick);
    rig.scene().move(left, {-x, 0, 0});
    rig.scene().move(right, {x, 0, 0});
    rig.tick(16);
  }
  rig.body(0).config.gravity_m_per_s2[2] = -kGravity;
  double slipped = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double t = tick * 1e-3, z = 0.02 * (1 - std::cos(2 * M_PI * 2 * t));  // at most 3.2 m/s^2, 0.25 m/s
    rig.scene().move(left, {depth - 0.005, 0, z});
    rig.scene().move(right, {0.005 - depth, 0, z});
    rig.tick(16);
    slipped = std::max(slipped, std::abs(rig.centre(0)[2] - z));
  }
  CAPTURE(slipped);
  CHECK(slipped < 1e-4);
}

TEST_CASE("forces and torques of the caller's act on a body of a scene until they are set anew") {
  PileRig rig;
  const auto cube = rig.box(kSide, kSide, kSide);
  fdcg_body_config config = weightless();
  rig.add_body(cube, kMass_kg, friction(0.5, 0.5), posed({0, 0, 0}), config);
  const double force[3] = {0.05, 0, 0}, torque[3] = {0, 0, 1e-5}, none[3] = {0, 0, 0};
  fdcg_error error;
  REQUIRE(fdcg_body_set_push(&rig.body(0), force, torque, &error) == FDCG_OK);
  rig.ticks(1000);
  CHECK(rig.velocity(0)[0] == Approx(0.05 / kMass_kg).epsilon(1e-9));
  double spin[3];
  fdcg_body_get_angular_velocity(&rig.body(0), spin);
  CHECK(spin[2] == Approx(1e-5 / (kMass_kg * kSide * kSide / 6)).epsilon(1e-6));
  REQUIRE(fdcg_body_set_push(&rig.body(0), none, none, &error) == FDCG_OK);
  rig.ticks(2);
  const double speed = rig.velocity(0)[0];
  rig.ticks(100);
  CHECK(rig.velocity(0)[0] == speed);
  const double wild[3] = {NAN, 0, 0};
  CHECK(fdcg_body_set_push(&rig.body(0), wild, none, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).starts_with("force_n[0] is "));
  CHECK(fdcg_body_set_push(nullptr, none, none, &error) == FDCG_E_ARGUMENT);
}
