// SPDX-License-Identifier: Apache-2.0
// Deformable meshes as objects of a scene: same forces as when stepped by hand, several fingers, beside graphs and surfaces, at
// rest and in motion; no finger falls through.
#include <cmath>
#include <cstring>
#include <string>

#include "catch.hpp"
#include "deform_rig.hpp"
#include "fdcg/pile.h"
#include "fdcg/surface.h"
#include "meshes.hpp"
#include "random.hpp"
#include "scene_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

fdcg_scene_config config_of(std::uint32_t disabled_optimizations = 0) {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.has_deforms = 1;
  config.disabled_optimizations = disabled_optimizations;
  return config;
}

fdcg_object_id add(SceneRig& rig, DeformableMesh& mesh, const fdcg_params& params, const fdcg_pose& pose) {
  fdcg_object_id id;
  fdcg_error error;
  if (fdcg_scene_add_deform(rig.get(), mesh.deform(), &params, &pose, &id, &error) != FDCG_OK) FAIL(error.message);
  return id;
}

// Sets every vertex of a sheet to the height of a travelling wave.
void heave(DeformableMesh& sheet, double height, double phase) {
  for (std::size_t v = 0; v < sheet.points().size(); ++v) {
    const bake::Vec3& p = sheet.points()[v];
    sheet.move(v, {p.x, p.y, height * std::sin(7 * p.x + 5 * p.y + phase)});
  }
}

// A ball that expands, shrinks and is dented: every vertex has its own distance from the centre.
void breathe(DeformableMesh& ball, const std::vector<bake::Vec3>& unit, double phase) {
  for (std::size_t v = 0; v < unit.size(); ++v) {
    const bake::Vec3& p = unit[v];
    ball.move(v, (1 + 0.3 * std::sin(phase) + 0.05 * std::sin(9 * p.x + 8 * p.y - 3 * phase)) * p);
  }
}

// Wanders about a middle, now and then far.
class Hand {
 public:
  Hand(double reach, std::uint64_t seed) : reach_(reach), random_(seed) { at_ = place(); }
  Place next() {
    if (random_.uniform(0, 1) < 0.01) aim_ = place();
    for (std::size_t k = 0; k < 3; ++k)
      at_[k] += 0.03 * (aim_[k] - at_[k]) + 0.002 * random_.uniform(-1, 1);
    return at_;
  }
  [[nodiscard]] const Place& at() const { return at_; }

 private:
  Place place() {
    return {random_.uniform(-reach_, reach_), random_.uniform(-reach_, reach_), random_.uniform(-reach_, reach_)};
  }
  double reach_;
  Random random_;
  Place at_{}, aim_{};
};

// FNV-1a.
void hash(std::uint64_t* sum, const void* data, std::size_t bytes) {
  const auto* byte = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < bytes; ++i)
    *sum = (*sum ^ byte[i]) * 0x100000001B3u;
}

struct Outcome {
  std::uint64_t hash = 0xCBF29CE484222325u, on_soft = 0, caught = 0;
};

// A sheet that heaves and one that moves about besides, a rigid ball and a surface; fingers among them, stepped in their order
// or backwards.
Outcome play(std::uint32_t disabled_optimizations, bool backwards) {
  constexpr std::uint32_t kFingers = 5;
  DeformableMesh still(plane_grid(12, 12)), moved(plane_grid(8, 8), triangle_options(bake::Precision::f32));
  const CompiledMesh ball(ico_sphere(2));
  SceneRig rig(config_of(disabled_optimizations));
  fdcg_params params = fdcg_make_params();
  const fdcg_object_id soft = add(rig, still, params, posed({0, 0, 0}));
  fdcg_pose pose = posed({0.2, 0, 0.3}, {1, 0, 0}, 0.4, 0.7);
  const fdcg_object_id also_soft = add(rig, moved, params, pose);
  rig.add(ball.view(), params, posed({0.3, 0.3, 0.2}, {0, 0, 1}, 0, 0.2));
  const fdcg_surface round = fdcg_make_sphere(0.2);
  const fdcg_pose there = posed({-0.3, 0, 0.1});
  fdcg_object_id id;
  REQUIRE(fdcg_scene_add_surface(rig.get(), &round, &params, &there, &id, nullptr) == FDCG_OK);
  std::vector<fdcg_finger_id> fingers;
  std::vector<Hand> hands;
  for (std::uint32_t f = 0; f < kFingers; ++f) {
    hands.emplace_back(f == 0 ? 3.0 : 0.5, 10 + f);
    fingers.push_back(rig.add(hands[f].next()));
  }
  Outcome outcome;
  for (int tick = 0; tick < 3000; ++tick) {
    if (tick % 500 < 400) heave(still, 0.2, 0.07 * tick);
    if (tick % 3 == 0) heave(moved, 0.1, 0.03 * tick);
    if (tick % 700 < 350) rig.pose(also_soft, pose = turned(pose, {0, 0.6, 0.8}, 0.002));
    for (std::uint32_t f = 0; f < kFingers; ++f)
      rig.move(fingers[f], hands[f].next());
    fdcg_scene_advance(rig.get());
    for (std::uint32_t f = 0; f < kFingers; ++f)
      REQUIRE(fdcg_scene_step_finger(rig.get(), fingers[backwards ? kFingers - 1 - f : f], nullptr) == FDCG_OK);
    for (const fdcg_finger_id finger : fingers) {
      const fdcg_finger_result felt = rig.result(finger);
      REQUIRE((felt.flags & FDCG_FINGER_CONTACT_OVERFLOW) == 0);
      hash(&outcome.hash, felt.force_n, sizeof felt.force_n);
      hash(&outcome.hash, &felt.flags, sizeof felt.flags);
      for (std::uint32_t t = 0; t < felt.touch_count; ++t) {
        fdcg_touch touch = felt.touches[t];
        touch.object.generation = 0;  // another one in each scene
        hash(&outcome.hash, &touch, sizeof touch);
      }
      for (std::uint32_t t = 0; t < felt.touch_count; ++t) {
        outcome.on_soft += felt.touches[t].object.index == soft.index || felt.touches[t].object.index == also_soft.index;
        outcome.caught += (felt.touches[t].flags & FDCG_DEFORM_CAUGHT) != 0;
        REQUIRE((felt.touches[t].flags & FDCG_DEFORM_MISSED) == 0);
      }
    }
  }
  return outcome;
}

// A finger that is put now here, now there, in a scene and by hand, and what feels it.
struct Placed {
  fdcg_finger_id finger;
  fdcg_deform_contact contact;
  Place at;
  int age;  // ticks since it was put there
};

// Fingers near a sheet that heaves are put somewhere else all the time and stay there for a few ticks, at rest or on the move.
// `turn` selects whether a finger is placed before the vertices move, after that, or between advance and step, and the order of
// the steps. Returns how many were caught in the tick after their placing.
std::uint64_t place_everywhere(std::uint32_t disabled_optimizations, bake::Precision precision, std::uint64_t ticks) {
  constexpr std::size_t kFingers = 4;
  DeformableMesh in_scene(plane_grid(10, 10), triangle_options(precision)),
      by_hand(plane_grid(10, 10), triangle_options(precision));
  const fdcg_params params = fdcg_make_params();
  SceneRig rig(config_of(disabled_optimizations));
  const fdcg_object_id object = add(rig, in_scene, params, fdcg_make_identity_pose());
  Random random(77);
  std::vector<Placed> placed(kFingers);
  const auto place = [&](Placed& p, bool is_new) {
    p.at = {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.2, 0.2)};
    p.contact = {};
    p.age = 0;
    if (is_new) {
      p.finger = rig.add(p.at);
    } else {
      REQUIRE(fdcg_scene_reset_finger(rig.get(), p.finger, p.at.data(), nullptr) == FDCG_OK);
    }
  };
  for (Placed& p : placed)
    place(p, true);
  std::uint64_t caught = 0;
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    const std::uint64_t turn = random.uniform(0, 1) < 0.5 ? 0 : tick % 3;
    const auto put_some = [&](std::uint64_t when) {
      if (turn != when) return;
      for (Placed& p : placed) {
        ++p.age;
        const double what = random.uniform(0, 1);
        if (what < 0.1) {
          REQUIRE(fdcg_scene_remove_finger(rig.get(), p.finger, nullptr) == FDCG_OK);
          place(p, true);
        } else if (what < 0.3) {
          place(p, false);
        } else if (what < 0.6) {
          p.at[2] += random.uniform(-0.02, 0.02);
          rig.move(p.finger, p.at);
        }
      }
    };
    put_some(0);
    if (tick % 8 != 7) {  // else the sheet rests
      heave(in_scene, 0.15, 0.4 * static_cast<double>(tick));
      heave(by_hand, 0.15, 0.4 * static_cast<double>(tick));
    }
    put_some(1);
    fdcg_scene_advance(rig.get());
    put_some(2);
    for (std::size_t f = 0; f < kFingers; ++f) {
      Placed& p = placed[tick % 2 == 0 ? f : kFingers - 1 - f];
      const fdcg_result result = by_hand.step(params, &p.contact, p.at);
      REQUIRE(fdcg_scene_step_finger(rig.get(), p.finger, nullptr) == FDCG_OK);
      const fdcg_finger_result felt = rig.result(p.finger);
      INFO("tick " << tick << " finger " << f << " age " << p.age << " turn " << turn);
      REQUIRE(felt.touch_count == (result.state != FDCG_FREE ? 1u : 0u));
      REQUIRE(std::memcmp(felt.force_n, result.force_n, sizeof felt.force_n) == 0);
      if (felt.touch_count == 0) continue;
      REQUIRE(felt.touches[0].object.index == object.index);
      REQUIRE(felt.touches[0].flags == result.flags);
      REQUIRE(std::memcmp(felt.touches[0].god_object_m, result.god_object_m, sizeof result.god_object_m) == 0);
      caught += p.age == 1 && (result.flags & FDCG_DEFORM_CAUGHT) != 0;
    }
  }
  return caught;
}

}  // namespace

TEST_CASE("optimizations among deformable meshes, and the order of fingers, do not change results") {
  const Outcome quick = play(0, false);
  CHECK(quick.on_soft > 1000);
  CHECK(quick.caught > 20);
  CHECK(play(0, true).hash == quick.hash);
  for (const std::uint32_t off : {1u, 2u, 4u, 8u, 16u, 31u}) {
    INFO("off " << off);
    CHECK(play(off, false).hash == quick.hash);
  }
}

TEST_CASE("a scene gives the bits of a contact with a deformable mesh stepped by hand") {
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    DeformableMesh in_scene(plane_grid(10, 10), triangle_options(precision)),
        by_hand(plane_grid(10, 10), triangle_options(precision));
    fdcg_params params = fdcg_make_params();
    params.mu_static = 0.5;
    params.mu_dynamic = 0.4;
    SceneRig rig(config_of());
    const fdcg_object_id object = add(rig, in_scene, params, fdcg_make_identity_pose());
    Hand hand(0.4, 3);  // always within the bounds, so that the scene steps it always
    const Place start = hand.next();
    const fdcg_finger_id finger = rig.add(start);
    fdcg_deform_contact contact = {};
    by_hand.step(params, &contact, start);
    rig.step();
    std::uint32_t touches = 0, caught = 0;
    for (int tick = 0; tick < 4000; ++tick) {
      if (tick % 400 < 300) {
        heave(in_scene, 0.25, 0.1 * tick);
        heave(by_hand, 0.25, 0.1 * tick);
      }
      const Place hip = hand.next();
      const fdcg_result result = by_hand.step(params, &contact, hip);
      rig.move(finger, hip);
      rig.step();
      const fdcg_finger_result felt = rig.result(finger);
      INFO("tick " << tick);
      REQUIRE(felt.touch_count == (result.state != FDCG_FREE ? 1u : 0u));
      REQUIRE(std::memcmp(felt.force_n, result.force_n, sizeof felt.force_n) == 0);
      if (felt.touch_count == 0) continue;
      ++touches;
      caught += (result.flags & FDCG_DEFORM_CAUGHT) != 0;
      REQUIRE(felt.touches[0].object.index == object.index);
      REQUIRE(felt.touches[0].state == result.state);
      REQUIRE(felt.touches[0].feature == result.feature);
      REQUIRE(felt.touches[0].flags == result.flags);
      REQUIRE(std::memcmp(felt.touches[0].god_object_m, result.god_object_m, sizeof result.god_object_m) == 0);
    }
    CHECK(touches > 500);
    CHECK(caught > 5);
  }
}

TEST_CASE("a new finger is caught by a surface passing over it in the next tick, in a scene as by hand") {
  CHECK(place_everywhere(0, bake::Precision::f64, steps_or(3000)) > 100);
  CHECK(place_everywhere(0, bake::Precision::f32, steps_or(1000)) > 30);
  for (const std::uint32_t off : {1u, 2u, 4u, 8u, 16u, 31u}) {
    INFO("off " << off);
    CHECK(place_everywhere(off, bake::Precision::f64, steps_or(500)) > 15);
  }
}

TEST_CASE("no finger is within a ball that breathes, moves and turns without being pushed out") {
  const bake::PolygonSoup soup = ico_sphere(3);
  DeformableMesh ball(soup);
  SceneRig rig(config_of());
  fdcg_pose pose = posed({0, 0, 0}, {0, 0, 1}, 0, 0.5);
  const fdcg_object_id object = add(rig, ball, fdcg_make_params(), pose);
  Random random(5);
  std::vector<fdcg_finger_id> fingers;
  std::vector<Hand> hands;
  for (std::uint32_t f = 0; f < 3; ++f) {
    hands.emplace_back(0.8, 70 + f);
    fingers.push_back(rig.add({5, 5, 5}));
  }
  std::uint64_t inside = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    breathe(ball, soup.points, 0.05 * tick);
    pose = turned(pose, direction(random), 0.02);
    for (double& x : pose.translation_m)
      x += 0.01 * random.uniform(-1, 1) - 0.002 * x;
    rig.pose(object, pose);
    for (std::size_t f = 0; f < fingers.size(); ++f) {
      // now and then it is somewhere else at once
      const Place at = tick % 300 == 0 ? Place{random.uniform(-2, 2), random.uniform(-2, 2), 2} : hands[f].next();
      rig.move(fingers[f], at);
      fdcg_error error;
      if (tick % 300 == 0 && fdcg_scene_reset_finger(rig.get(), fingers[f], at.data(), &error) != FDCG_OK) FAIL(error.message);
    }
    rig.step();
    for (std::size_t f = 0; f < fingers.size(); ++f) {
      if (tick % 300 == 0) continue;
      const Place& at = hands[f].at();
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k)
        square += (at[k] - pose.translation_m[k]) * (at[k] - pose.translation_m[k]);
      const double least = 0.5 * 0.97 * (0.95 + 0.3 * std::sin(0.05 * tick));  // facets are less than 3 % within the sphere
      if (!(square < least * least)) continue;
      ++inside;
      INFO("tick " << tick << " finger " << f);
      REQUIRE(rig.result(fingers[f]).touch_count == 1);
    }
  }
  CHECK(inside > 1000);
}

TEST_CASE("a force on a deformable mesh is in world units, and its object gets the opposite") {
  DeformableMesh sheet(plane_grid(4, 4));
  SceneRig rig(config_of());
  fdcg_params params = fdcg_make_params();
  params.stiffness_n_per_m = 1000;
  const fdcg_object_id object = add(rig, sheet, params, posed({0, 0, 1}, {0, 0, 1}, 0, 3));
  const fdcg_finger_id finger = rig.add({0.3, 0.2, 1.1}), other = rig.add({-0.3, 0.2, 1.1});
  rig.step();
  rig.move(finger, {0.3, 0.2, 0.99});
  rig.move(other, {-0.3, 0.2, 0.98});
  rig.step();
  CHECK(rig.result(finger).force_n[2] == Approx(10));
  CHECK(rig.result(other).force_n[2] == Approx(20));
  CHECK(rig.result(other).touches[0].god_object_m[2] == Approx(1));
  fdcg_reaction reaction;
  fdcg_scene_get_reactions(rig.get(), &reaction, 1);
  CHECK(object.index == 0);
  CHECK(reaction.force_n[2] == Approx(-30));
  CHECK(reaction.torque_n_m[1] == Approx(0.3 * 10 - 0.3 * 20));
}

TEST_CASE("a deformable mesh is refused without room for it, and by piles") {
  DeformableMesh sheet(plane_grid(2, 2));
  const fdcg_params params = fdcg_make_params();
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_object_id id;
  fdcg_error error;
  SceneRig without(fdcg_make_scene_config()), with(config_of());
  CHECK(fdcg_scene_add_deform(without.get(), sheet.deform(), &params, &pose, &id, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("set config.has_deforms to 1") != std::string::npos);
  CHECK(fdcg_scene_add_deform(with.get(), nullptr, &params, &pose, &id, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("deform: null pointer") != std::string::npos);
  CHECK(fdcg_scene_add_deform(with.get(), sheet.deform(), nullptr, &pose, &id, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_scene_add_deform(with.get(), sheet.deform(), &params, nullptr, &id, &error) == FDCG_E_ARGUMENT);
  REQUIRE(fdcg_scene_add_deform(with.get(), sheet.deform(), &params, &pose, &id, &error) == FDCG_OK);

  const fdcg_pile_config config = fdcg_make_pile_config();
  std::vector<std::uint64_t> memory(fdcg_pile_bytes(&config) / 8 + 1);
  fdcg_pile* pile = nullptr;
  REQUIRE(fdcg_pile_create(memory.data(), memory.size() * 8, &config, &pile, &error) == FDCG_OK);
  CHECK(fdcg_pile_add(pile, with.get(), id, nullptr, 0, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("is a deformable mesh, which bodies do not meet") != std::string::npos);

  fdcg_scene_config wrong = config_of();
  wrong.has_deforms = 2;
  CHECK(fdcg_scene_bytes(&wrong) == 0);
  const fdcg_scene_config small = fdcg_make_scene_config(), large = config_of();
  CHECK(fdcg_scene_bytes(&large) - fdcg_scene_bytes(&small) == 8 * 4 * (sizeof(fdcg_deform_contact) - sizeof(fdcg_contact)));
}

TEST_CASE("a deformable mesh removed and added again is felt anew") {
  DeformableMesh sheet(plane_grid(4, 4));
  SceneRig rig(config_of());
  fdcg_object_id object = add(rig, sheet, fdcg_make_params(), fdcg_make_identity_pose());
  const fdcg_finger_id finger = rig.add({0.1, 0.1, 0.1});
  rig.step();
  rig.move(finger, {0.1, 0.1, -0.01});
  rig.step();
  CHECK(rig.result(finger).touch_count == 1);
  REQUIRE(fdcg_scene_enable_object(rig.get(), object, 0, nullptr) == FDCG_OK);
  rig.step();
  CHECK(rig.result(finger).touch_count == 0);
  REQUIRE(fdcg_scene_enable_object(rig.get(), object, 1, nullptr) == FDCG_OK);
  rig.move(finger, {0.1, 0.1, 0.1});
  rig.step();
  CHECK(rig.result(finger).touch_count == 0);
  for (std::size_t v = 0; v < sheet.points().size(); ++v)  // over the finger
    sheet.move(v, {sheet.points()[v].x, sheet.points()[v].y, 0.3});
  rig.step();
  REQUIRE(rig.result(finger).touch_count == 1);
  CHECK((rig.result(finger).touches[0].flags & FDCG_DEFORM_CAUGHT) != 0);
  REQUIRE(fdcg_scene_remove_object(rig.get(), object, nullptr) == FDCG_OK);
  rig.step();
  CHECK(rig.result(finger).touch_count == 0);
  object = add(rig, sheet, fdcg_make_params(), fdcg_make_identity_pose());
  rig.move(finger, {0.1, 0.1, 0.6});
  rig.step();
  rig.move(finger, {0.1, 0.1, 0});
  rig.step();
  CHECK(rig.result(finger).touch_count == 1);
}
