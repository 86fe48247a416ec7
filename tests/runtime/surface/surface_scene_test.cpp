// SPDX-License-Identifier: Apache-2.0
// Surfaces as objects of a scene: felt as by hand, whatever is skipped, from a plane without end to a ball that is held.
#include <cstring>
#include <memory>

#include "catch.hpp"
#include "fdcg/body.h"
#include "scene_rig.hpp"
#include "surface_rig.hpp"

using namespace fdcg::test;

namespace {

fdcg_object_id add(SceneRig& rig, const fdcg_surface& surface, const fdcg_params& params, const fdcg_pose& pose) {
  fdcg_object_id id;
  fdcg_error error;
  if (fdcg_scene_add_surface(rig.get(), &surface, &params, &pose, &id, &error) != FDCG_OK) FAIL(error.message);
  return id;
}

// FNV-1a.
void hash(std::uint64_t* sum, const void* data, std::size_t bytes) {
  const auto* byte = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < bytes; ++i)
    *sum = (*sum ^ byte[i]) * 0x100000001B3u;
}

struct Outcome {
  std::uint64_t hash = 0xCBF29CE484222325u, touches = 0, broadphase_updates = 0;
};

// Every kind of surface, some on the move, and fingers among them.
Outcome play(std::uint64_t seed, std::uint32_t disabled_optimizations, bool has_plane, bool plane_turns) {
  constexpr std::uint32_t kFingers = 6, kKinds = 8, kTicks = 1500;
  Random random(seed);
  fdcg_scene_config config = fdcg_make_scene_config();
  config.disabled_optimizations = disabled_optimizations;
  config.finger_capacity = kFingers;
  SceneRig rig(config);
  std::vector<fdcg_object_id> objects;
  std::vector<fdcg_pose> poses;
  for (std::uint32_t i = has_plane ? 0 : 1; i < 3 * kKinds; ++i) {
    const std::uint32_t kind = i % kKinds;
    if (kind == FDCG_SURFACE_PLANE && i > 0) continue;
    fdcg_params params = fdcg_make_params();
    params.mu_static = params.mu_dynamic = random.uniform(0, 1);
    const double room = kind == FDCG_SURFACE_PLANE ? 0 : 1;
    fdcg_pose pose =
        posed({room * random.uniform(-1, 1), room * random.uniform(-1, 1), room * random.uniform(-1, 1) - (1 - room)},
              direction(random), i == 0 ? 0.1 : random.uniform(0, 3), random.uniform(0.5, 2));
    objects.push_back(add(rig, random_surface(kind, i / kKinds == 1, 0.3, 4, random), params, pose));
    poses.push_back(pose);
  }
  std::vector<fdcg_finger_id> fingers;
  std::vector<SurfaceHand> hands;
  for (std::uint32_t f = 0; f < kFingers; ++f) {
    hands.emplace_back(f < 2 ? 1.0 : 4.0, seed * 100 + f);
    fingers.push_back(rig.add(hands[f].next()));
  }
  Outcome outcome;
  for (std::uint32_t tick = 0; tick < kTicks; ++tick) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (i % 3 != 0 || tick % 200 > 150 || (i == 0 && has_plane && !plane_turns && tick % 2 == 0)) continue;
      if (i > 0 || !has_plane || plane_turns) poses[i] = turned(poses[i], direction(random), 0.01);
      poses[i].translation_m[2] += 0.002 * random.uniform(-1, 1);
      rig.pose(objects[i], poses[i]);
    }
    for (std::uint32_t f = 0; f < kFingers; ++f)
      rig.move(fingers[f], hands[f].next());
    rig.step();
    for (const fdcg_finger_id finger : fingers) {
      const fdcg_finger_result felt = rig.result(finger);
      hash(&outcome.hash, felt.force_n, sizeof felt.force_n);
      hash(&outcome.hash, &felt.flags, sizeof felt.flags);
      hash(&outcome.hash, felt.touches, felt.touch_count * sizeof *felt.touches);
      outcome.touches += felt.touch_count;
    }
  }
  for (const fdcg_finger_id finger : fingers)
    outcome.broadphase_updates += rig.result(finger).broadphase_updates;
  return outcome;
}

}  // namespace

TEST_CASE("optimizations among surfaces do not change results") {
  for (const bool has_plane : {false, true}) {
    for (const bool plane_turns : {false, true}) {
      const Outcome quick = play(7, 0, has_plane, plane_turns);
      CHECK(quick.touches > 500);
      for (const std::uint32_t off : {1u, 2u, 4u, 8u, 16u, 31u}) {
        const Outcome other = play(7, off, has_plane, plane_turns);
        INFO("off " << off << " plane " << has_plane << " turns " << plane_turns);
        CHECK(other.hash == quick.hash);
        CHECK(other.touches == quick.touches);
      }
    }
  }
}

TEST_CASE("a scene gives the bits of a contact stepped by hand") {
  for (std::uint32_t kind = 0; kind <= FDCG_SURFACE_ELLIPSOID; ++kind) {
    Random random(kind);
    const fdcg_surface surface = random_surface(kind, kind % 2 != 0, 1, 3, random);
    SurfaceContact by_hand(surface, 0.5, 0.4);
    SceneRig rig(fdcg_make_scene_config());
    const fdcg_object_id object = add(rig, surface, by_hand.params(), fdcg_make_identity_pose());
    SurfaceHand hand(1, kind + 50);
    const Place start = hand.next();
    const fdcg_finger_id finger = rig.add(start);
    by_hand.step(start);
    rig.step();
    int touches = 0;
    for (int i = 0; i < 3000; ++i) {
      const Place hip = hand.next();
      by_hand.step(hip);
      rig.move(finger, hip);
      rig.step();
      const fdcg_finger_result felt = rig.result(finger);
      INFO(name_of(kind) << " tick " << i);
      REQUIRE(felt.touch_count == (by_hand.result.state != FDCG_FREE ? 1u : 0u));
      for (int k = 0; k < 3; ++k)
        REQUIRE(felt.force_n[k] == by_hand.result.force_n[k]);
      if (felt.touch_count == 0) continue;
      ++touches;
      REQUIRE(felt.touches[0].object.index == object.index);
      REQUIRE(felt.touches[0].state == by_hand.result.state);
      REQUIRE(felt.touches[0].feature == by_hand.result.feature);
    }
    CHECK(touches > 100);
  }
}

TEST_CASE("a finger high above a plane updates its broad phase rarely") {
  SceneRig rig(fdcg_make_scene_config());
  add(rig, fdcg_make_plane(), fdcg_make_params(), fdcg_make_identity_pose());
  const fdcg_finger_id finger = rig.add({0, 0, 1});
  for (int i = 0; i < 10000; ++i) {
    rig.move(finger, {1e-4 * i, 0, 1});
    rig.step();
  }
  CHECK(rig.result(finger).broadphase_updates < 100);
  rig.move(finger, {1, 0, -0.01});
  rig.step();
  CHECK(rig.result(finger).touch_count == 1);
  CHECK(rig.result(finger).force_n[2] == Approx(10));
}

TEST_CASE("two fingers hold a ball for a million ticks in place") {
  const fdcg_surface ball = fdcg_make_sphere(0.03);
  SceneRig rig(fdcg_make_scene_config());
  fdcg_params params = fdcg_make_params();
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_scene_body body = {};
  body.object = add(rig, ball, params, pose);
  fdcg_mass mass;
  fdcg_error error;
  REQUIRE(fdcg_surface_get_mass(&ball, &mass, &error) == FDCG_OK);
  fdcg_body_config config = fdcg_make_body_config();
  config.linear_damping_per_s = config.angular_damping_per_s = 20;
  config.sleep_after_s = 0;
  REQUIRE(fdcg_body_set_mass(&config, &mass, 500, 1, &error) == FDCG_OK);
  REQUIRE(fdcg_body_init(&body.body, &config, &pose, &error) == FDCG_OK);
  const fdcg_finger_id left = rig.add({-0.04, 0, 0.001}), right = rig.add({0.04, 0, 0.001});
  rig.step();
  rig.move(left, {-0.028, 0, 0.001});
  rig.move(right, {0.028, 0, 0.001});
  rig.step();
  fdcg_reaction reaction;
  const auto tick = [&] { REQUIRE(fdcg_scene_step_bodies(rig.get(), &body, 1, 1, 1e-3, &reaction, 1, &error) == FDCG_OK); };
  for (int i = 0; i < 20000; ++i)
    tick();
  const double before[3] = {body.body.centre_m[0], body.body.centre_m[1], body.body.centre_m[2]};
  CHECK(before[2] > -0.001);  // it hangs
  for (int i = 0; i < 1000000; ++i)
    tick();
  for (int k = 0; k < 3; ++k)
    CHECK(std::abs(body.body.centre_m[k] - before[k]) < 1e-9);
}
