// SPDX-License-Identifier: Apache-2.0
// Piles: contact points, conservation, skipped work, refusals.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "catch.hpp"
#include "pile_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kSide = 0.04, kMass_kg = 0.05;

fdcg_body_config weightless() {
  fdcg_body_config config = fdcg_make_body_config();
  config.gravity_m_per_s2[2] = 0;
  config.sleep_after_s = 0;
  return config;
}

struct Totals {
  Place momentum = {0, 0, 0}, angular = {0, 0, 0};
  double energy_j = 0;
};

Totals totals(PileRig& rig) {
  Totals sum;
  for (std::size_t i = 0; i < rig.bodies().size(); ++i) {
    const fdcg_body& body = rig.body(i);
    // without the predicted impulse of the last step
    const Place momentum = rig.velocity(i) * body.config.mass_kg - place(body.predicted_impulse_n_s);
    sum.momentum = sum.momentum + momentum;
    sum.angular = sum.angular + place(body.angular_momentum) - place(body.given_n_m_s) + cross(rig.centre(i), momentum);
    sum.energy_j += fdcg_body_get_kinetic_energy_j(&body);
  }
  return sum;
}

void set_motion(fdcg_body& body, const Place& velocity, const Place& spin) {
  fdcg_error error;
  REQUIRE(fdcg_body_set_motion(&body, velocity.data(), spin.data(), &error) == FDCG_OK);
}

}  // namespace

TEST_CASE("contact points of a box are its corners, then its edges' midpoints, inset by a thousandth") {
  PileRig rig;
  const auto box = rig.box(0.06, 0.04, 0.02);
  const Place half = {0.03, 0.02, 0.01};
  double points[256][3];
  std::uint32_t count = 0;
  fdcg_error error;
  REQUIRE(fdcg_pick_points(&rig.graph(box), points, 8, &count, &error) == FDCG_OK);
  REQUIRE(count == 8);
  for (std::uint32_t p = 0; p < 8; ++p) {
    for (int k = 0; k < 3; ++k)
      CHECK(std::abs(points[p][k]) == Approx(half[k] * (1 - 0x1p-10)).epsilon(1e-12));
    for (std::uint32_t q = 0; q < p; ++q)
      CHECK(std::memcmp(points[p], points[q], sizeof points[p]) != 0);
  }
  REQUIRE(fdcg_pick_points(&rig.graph(box), points, 12, &count, &error) == FDCG_OK);
  REQUIRE(count == 12);
  for (std::uint32_t p = 8; p < 12; ++p) {
    CHECK(std::abs(points[p][0]) < 1e-15);  // the four longest edges come first
    CHECK(std::abs(points[p][1]) == Approx(half[1] * (1 - 0x1p-10)).epsilon(1e-12));
  }
  const auto ball = rig.shape(scaled(ico_sphere(3), 0.02));
  REQUIRE(fdcg_pick_points(&rig.graph(ball), points, 64, &count, &error) == FDCG_OK);
  CHECK(count == 64);  // no edge of it is sharp, and more corners than that
  Place sum = {0, 0, 0};
  for (std::uint32_t p = 0; p < count; ++p)
    sum = sum + place(points[p]);
  CHECK(norm(sum) / count < 0.2 * 0.02);  // on all sides
  CHECK(fdcg_pick_points(&rig.graph(ball), points, 257, &count, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message) == "capacity is 257, allowed 1 to 256");
}

TEST_CASE("bodies that collide keep momentum and angular momentum and gain no energy") {
  for (const std::uint32_t substeps : {1U, 4U}) {
    for (int run = 0; run < 12; ++run) {
      PileRig rig;
      const auto cube = rig.box(kSide, kSide, kSide), slab = rig.box(0.08, 0.06, 0.02);
      Random random(static_cast<std::uint64_t>(run) + 5);
      const Place axis = direction(random), other_axis = direction(random);
      rig.add_body(cube, kMass_kg, friction(0.6, 0.4, 4000), posed({-0.07, 0.005 * (run % 4), 0}, axis, run), weightless());
      rig.add_body(slab, 3 * kMass_kg, friction(0.6, 0.4, 4000), posed({0.07, 0, 0.004 * (run % 3)}, other_axis, 2.0 * run),
                   weightless());
      set_motion(rig.body(0), {1, 0, 0}, direction(random) * 8);
      set_motion(rig.body(1), {-0.5, 0, 0}, direction(random) * 4);
      const Totals before = totals(rig);
      double most_energy = 0;
      std::size_t touched = 0;
      for (int tick = 0; tick < 300; ++tick) {
        rig.tick(substeps);
        touched += rig.touches().size();
        most_energy = std::max(most_energy, totals(rig).energy_j);
      }
      const Totals after = totals(rig);
      CAPTURE(substeps, run, touched);
      CHECK(touched > 0);
      CHECK(norm(after.momentum - before.momentum) < 1e-13);
      CHECK(norm(after.angular - before.angular) < 1e-13);
      CHECK(most_energy <= before.energy_j * (1 + 1e-9));
      CHECK(after.energy_j < 0.95 * before.energy_j);
    }
  }
}

TEST_CASE("distant bodies are skipped by the broad phase, and a thousand isolated ones cost no step") {
  fdcg_scene_config scene = fdcg_make_scene_config();
  PileRig rig(fdcg_make_pile_config(), scene);
  const auto cube = rig.box(kSide, kSide, kSide);
  for (int i = 0; i < 6; ++i)
    rig.add_body(cube, kMass_kg, friction(0.5, 0.4), posed({0.5 * i, 0, 0.3}), weightless());
  for (int i = 0; i < 58; ++i)
    rig.add_fixed(cube, friction(0.5, 0.4), posed({0.1 * i, 5, 0}));
  for (int i = 0; i < 6; ++i)
    set_motion(rig.body(static_cast<std::size_t>(i)), {0, 0.01 * i, 0}, {1, 2, 3});
  rig.ticks(1000);
  const fdcg_pile_counts counts = fdcg_pile_get_counts(rig.pile());
  CHECK(counts.steps == 0);
  CHECK(counts.broadphase_updates <= 12);
}

TEST_CASE("a moving plate carries the body on it; removed, the body falls") {
  PileRig rig;
  const auto cube = rig.box(kSide, kSide, kSide), plate = rig.box(0.5, 0.5, 0.02);
  const fdcg_object_id floor = rig.add_fixed(plate, friction(0.5, 0.4), posed({0, 0, -0.01}));
  rig.add_body(cube, kMass_kg, friction(0.5, 0.4), posed({0, 0, 0.021}));
  rig.ticks(1500);
  REQUIRE(rig.body(0).is_asleep == 1);
  for (int tick = 1; tick <= 1000; ++tick) {  // 0.1 m in a second, softly
    const double share = 0.5 - 0.5 * std::cos(M_PI * tick / 1000);
    rig.scene().pose(floor, posed({0.1 * share, 0, -0.01}));
    rig.tick();
  }
  rig.ticks(1000);
  CHECK(rig.centre(0)[0] == Approx(0.1).margin(1e-6));
  REQUIRE(rig.body(0).is_asleep == 1);
  SECTION("the object leaves the scene") {
    fdcg_error error;
    REQUIRE(fdcg_scene_remove_object(rig.scene().get(), floor, &error) == FDCG_OK);
  }
  SECTION("the object is disabled") {
    fdcg_error error;
    REQUIRE(fdcg_scene_enable_object(rig.scene().get(), floor, 0, &error) == FDCG_OK);
  }
  SECTION("the object leaves the pile") {
    fdcg_error error;
    REQUIRE(fdcg_pile_remove(rig.pile(), floor, &error) == FDCG_OK);
    CHECK(fdcg_pile_remove(rig.pile(), floor, &error) == FDCG_E_ARGUMENT);
  }
  rig.ticks(100);
  CHECK(rig.body(0).is_asleep == 0);
  CHECK(rig.touches().empty());
  CHECK(rig.velocity(0)[2] < -0.9);
}

TEST_CASE("a copy of scene, pile and bodies goes on with the same bits") {
  PileRig rig;
  const auto cube = rig.box(kSide, kSide, kSide);
  rig.ground({0, 0, 1}, 0, friction(0.5, 0.4));
  for (int i = 0; i < 3; ++i)
    rig.add_body(cube, kMass_kg, friction(0.5, 0.4), posed({0.01 * i, 0, 0.03 + 0.05 * i}, {0, 0.6, 0.8}, 0.4 * i));
  rig.ticks(150);
  std::vector<std::uint64_t> scene = rig.scene().memory(), pile = rig.memory();
  std::vector<fdcg_scene_body> bodies = rig.bodies();
  std::vector<fdcg_reaction> reactions(64);
  fdcg_error error;
  rig.ticks(300);
  for (int tick = 0; tick < 300; ++tick) {
    REQUIRE(fdcg_scene_step_pile(reinterpret_cast<fdcg_scene*>(scene.data()), reinterpret_cast<fdcg_pile*>(pile.data()),
                                 bodies.data(), 3, 1, 1e-3, reactions.data(), 64, &error) == FDCG_OK);
  }
  CHECK(std::memcmp(bodies.data(), rig.bodies().data(), sizeof(fdcg_scene_body) * 3) == 0);
}

TEST_CASE("a pile without room for a touch reports it, and one too stiff for its step stays bounded") {
  fdcg_pile_config config = fdcg_make_pile_config();
  config.touch_capacity = 2;
  PileRig small(config);
  small.ground({0, 0, 1}, 0, friction(0.5, 0.4));
  small.add_body(small.box(kSide, kSide, kSide), kMass_kg, friction(0.5, 0.4), posed({0, 0, 0.021}));
  small.ticks(100);
  CHECK(fdcg_pile_get_counts(small.pile()).overflowed_contacts > 0);
  CHECK(small.touches().size() == 2);

  PileRig stiff;
  const auto cube = stiff.box(kSide, kSide, kSide);
  stiff.ground({0, 0, 1}, 0, friction(0.5, 0.4, 1e9));
  for (int i = 0; i < 3; ++i)
    stiff.add_body(cube, kMass_kg, friction(0.5, 0.4, 1e9), posed({0, 0, 0.021 + 0.041 * i}));
  for (int tick = 0; tick < 3000; ++tick) {
    stiff.tick();
    for (std::size_t i = 0; i < 3; ++i)
      REQUIRE(norm(stiff.velocity(i)) < 1.2);
  }
  CHECK(stiff.centre(2)[2] == Approx(0.1).margin(0.001));
}

TEST_CASE("invalid piles are refused with field, value and limit") {
  fdcg_error error = {};
  fdcg_pile_config config = fdcg_make_pile_config();
  config.touch_capacity = 0;
  CHECK(fdcg_pile_bytes(&config) == 0);
  fdcg_pile* pile = nullptr;
  std::vector<std::uint64_t> memory(100000);
  CHECK(fdcg_pile_create(memory.data(), memory.size() * 8, &config, &pile, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message) == "config.touch_capacity is 0, allowed 1 to 1e6");
  config = fdcg_make_pile_config();
  config.damping_ratio = std::nan("");
  CHECK(fdcg_pile_create(memory.data(), memory.size() * 8, &config, &pile, &error) == FDCG_E_ARGUMENT);
  config = fdcg_make_pile_config();
  CHECK(fdcg_pile_create(memory.data(), 100, &config, &pile, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("bytes is 100, this config needs") == 0);
  CHECK(fdcg_pile_create(reinterpret_cast<char*>(memory.data()) + 4, 1, &config, &pile, &error) == FDCG_E_ALIGNMENT);

  PileRig rig;
  const auto cube = rig.box(kSide, kSide, kSide);
  const fdcg_object_id object = rig.add_fixed(cube, friction(0.5, 0.4), fdcg_make_identity_pose());
  const fdcg_params params = friction(0.5, 0.4);
  const double slanted[3] = {0, 1, 1}, up[3] = {0, 0, 1};
  CHECK(fdcg_pile_set_ground(rig.pile(), slanted, 0, &params, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("normal's length is 1.41421") == 0);
  CHECK(fdcg_pile_set_ground(rig.pile(), up, std::nan(""), &params, &error) == FDCG_E_ARGUMENT);
  const double far[1][3] = {{0, HUGE_VAL, 0}};
  CHECK(fdcg_pile_add(rig.pile(), rig.scene().get(), object, far, 1, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("points_m[0][1] is") == 0);
  CHECK(fdcg_pile_add(rig.pile(), rig.scene().get(), {9, 1}, far, 0, &error) == FDCG_E_ARGUMENT);
  const std::vector<std::array<double, 3>> many(129);
  CHECK(fdcg_pile_add(rig.pile(), rig.scene().get(), object, reinterpret_cast<const double(*)[3]>(many.data()), 129, &error) ==
        FDCG_E_ARGUMENT);
  CHECK(std::string(error.message) == "point_count is 129, config.point_capacity leaves 128");
  fdcg_scene_body body = {};
  fdcg_reaction reaction;
  CHECK(fdcg_scene_step_pile(rig.scene().get(), nullptr, &body, 1, 1, 1e-3, &reaction, 1, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_scene_step_pile(rig.scene().get(), rig.pile(), &body, 1, 65, 1e-3, &reaction, 1, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_scene_step_pile(rig.scene().get(), rig.pile(), &body, 1, 1, std::nan(""), &reaction, 1, &error) ==
        FDCG_E_ARGUMENT);
}

TEST_CASE("an object that is given twice among the bodies is refused, and nothing moves") {
  PileRig rig;
  const auto cube = rig.box(0.1, 0.1, 0.1);
  for (int i = 0; i < 3; ++i)
    rig.add_body(cube, 1, friction(0.5, 0.4), posed({0.0, 0.0, 1.0 * i}));
  rig.tick();
  const Place at = rig.centre(1);
  std::vector<fdcg_scene_body> bodies = rig.bodies();
  bodies.insert(bodies.begin() + 2, bodies[1]);
  std::vector<fdcg_reaction> reactions(4, {{1, 1, 1}, {1, 1, 1}});
  fdcg_error error = {};
  const auto step = [&](bool with_pile) {
    fdcg_scene* const scene = rig.scene().get();
    return with_pile ? fdcg_scene_step_pile(scene, rig.pile(), bodies.data(), 4, 1, 1e-3, reactions.data(), 4, &error)
                     : fdcg_scene_step_bodies(scene, bodies.data(), 4, 1, 1e-3, reactions.data(), 4, &error);
  };
  for (const bool with_pile : {false, true}) {
    CHECK(step(with_pile) == FDCG_E_ARGUMENT);
    CHECK(std::string(error.message) == "body 2: its object is that of body 1 too; an object is one body's: give each its own");
    CHECK(place(bodies[1].body.centre_m) == at);
    CHECK(reactions[1].force_n[0] == 0);
  }
}

TEST_CASE("a block on a plane that is a surface sticks and slides as on the ground, and a ball carries what is laid on it") {
  for (const double share : {0.998, 1.002}) {
    PileRig rig;
    fdcg_error error;
    const double mu = 0.5, angle = std::atan(mu * share);
    const fdcg_surface plane = fdcg_make_plane();
    const fdcg_params params = friction(mu, mu);
    const fdcg_pose pose = posed({0, 0, 0}, {0, 1, 0}, angle);
    fdcg_object_id slope;
    REQUIRE(fdcg_scene_add_surface(rig.scene().get(), &plane, &params, &pose, &slope, &error) == FDCG_OK);
    REQUIRE(fdcg_pile_add(rig.pile(), rig.scene().get(), slope, nullptr, 0, &error) == FDCG_OK);
    fdcg_body_config awake = fdcg_make_body_config();
    awake.sleep_after_s = 0;
    const auto block = rig.box(0.08, 0.08, 0.01);
    rig.add_body(block, kMass_kg, params, posed({0.006 * std::sin(angle), 0, 0.006 * std::cos(angle)}, {0, 1, 0}, angle), awake,
                 8);
    rig.ticks(600);
    const Place at = rig.centre(0);
    rig.ticks(300);
    CAPTURE(share, norm(rig.centre(0) - at));
    CHECK(rig.touches().size() == 4);
    CHECK(rig.touches()[0].normal[0] == Approx(std::sin(angle)));
    CHECK((norm(rig.centre(0) - at) < 1e-9) == (share < 1));
    CHECK((norm(rig.centre(0) - at) > 1e-5) == (share > 1));
  }
  PileRig rig;
  fdcg_error error;
  const fdcg_surface ball = fdcg_make_sphere(1);
  const fdcg_params params = friction(0.6, 0.5);
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_object_id hill;
  REQUIRE(fdcg_scene_add_surface(rig.scene().get(), &ball, &params, &pose, &hill, &error) == FDCG_OK);
  REQUIRE(fdcg_pile_add(rig.pile(), rig.scene().get(), hill, nullptr, 0, &error) == FDCG_OK);
  rig.add_body(rig.box(0.04, 0.04, 0.01), kMass_kg, params, posed({0, 0, 1.006}));
  rig.ticks(2000);
  CHECK(rig.body(0).is_asleep == 1);
  CHECK(rig.centre(0)[2] == Approx(1.005).margin(1e-3));
}

TEST_CASE("materials of two objects combine: friction by the geometric mean, springs in series") {
  PileRig rig;
  fdcg_body_config awake = fdcg_make_body_config();
  awake.sleep_after_s = 0;
  rig.ground({0, 0, 1}, 0, friction(0.9, 0.8, 600));
  rig.add_body(rig.box(0.08, 0.08, 0.01), kMass_kg, friction(0.4, 0.2, 300), posed({0, 0, 0.006}), awake, 8);
  rig.ticks(1000);
  for (const fdcg_pile_touch& touch : rig.touches())
    CHECK(touch.stiffness_n_per_m == Approx(200));
  for (int tick = 1; tick <= 600; ++tick) {
    rig.body(0).config.gravity_m_per_s2[0] =
        0.54 * 9.80665 * std::min(1.0, tick / 500.0);  // sqrt(0.4 * 0.9) = 0.6, its upper edge's 0.55
    rig.tick();
  }
  CHECK(std::abs(rig.velocity(0)[0]) < 1e-3);
  rig.body(0).config.gravity_m_per_s2[0] = 0.61 * 9.80665;
  rig.ticks(300);
  const double before = rig.velocity(0)[0];
  rig.ticks(100);
  CHECK((rig.velocity(0)[0] - before) / 0.1 == Approx((0.61 - 0.4) * 9.80665).epsilon(1e-3));  // sqrt(0.2 * 0.8) = 0.4
}
