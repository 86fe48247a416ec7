// SPDX-License-Identifier: Apache-2.0
// The functions of a scene. Over 400 lines: short cases, one for each guarantee of scene.h, in its order.
#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <thread>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "fdcg/fdcg.hpp"
#include "fdcg/soft_finger.h"
#include "heap_count.hpp"
#include "meshes.hpp"
#include "scene_rig.hpp"

using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::Equals;

namespace {

// A cube of 1 m about its origin, frictionless, 1,000 N/m.
struct Rig {
  explicit Rig(const fdcg_scene_config& config = fdcg_make_scene_config(), const fdcg_pose& pose = posed({0, 0, 0}))
      : mesh(cube()), params(contact_params(0, 0)), scene(config), object(scene.add(mesh.view(), params, pose)) {}

  // Two steps: first above the top face, then there.
  fdcg_finger_id pressing(const Place& hip) {
    const fdcg_finger_id finger = scene.add({hip[0], hip[1], 2});
    scene.step();
    scene.move(finger, hip);
    scene.step();
    return finger;
  }

  CompiledMesh mesh;
  fdcg_params params;
  SceneRig scene;
  fdcg_object_id object;
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

std::string refusal_of(Rig& rig, const fdcg_pose& pose) {
  fdcg_error error = {};
  CHECK(fdcg_scene_set_pose(rig.scene.get(), rig.object, &pose, &error) == FDCG_E_ARGUMENT);
  return error.message;
}

std::string refusal_of(const fdcg_scene_config& config) {
  std::vector<std::uint64_t> memory(100000);
  fdcg_scene* scene = nullptr;
  fdcg_error error = {};
  CHECK(fdcg_scene_bytes(&config) == 0);
  CHECK(fdcg_scene_create(memory.data(), memory.size() * 8, &config, &scene, &error) == FDCG_E_ARGUMENT);
  CHECK(scene == nullptr);
  return error.message;
}

}  // namespace

TEST_CASE("a finger feels an object where its pose puts it") {
  // turned by 90 degrees about x, twice as large, away from the origin: its top lies at z = 5 + 1
  Rig rig(fdcg_make_scene_config(), posed({3, 4, 5}, {1, 0, 0}, 1.5707963267948966, 2));
  const fdcg_finger_id finger = rig.scene.add({3.1, 4.2, 7});
  rig.scene.step();
  rig.scene.move(finger, {3.1, 4.2, 5.99});
  rig.scene.step();
  const fdcg_finger_result felt = rig.scene.result(finger);
  REQUIRE(felt.touch_count == 1);
  CHECK(felt.force_n[0] == Approx(0).margin(1e-9));
  CHECK(felt.force_n[1] == Approx(0).margin(1e-9));
  CHECK(felt.force_n[2] == Approx(10));  // 1,000 N/m of the world's 10 mm
  CHECK(felt.touches[0].god_object_m[0] == Approx(3.1));
  CHECK(felt.touches[0].god_object_m[1] == Approx(4.2));
  CHECK(felt.touches[0].god_object_m[2] == Approx(6));
  CHECK(felt.touches[0].object.index == rig.object.index);
  CHECK(felt.touches[0].object.generation == rig.object.generation);
  CHECK(felt.touches[0].state == FDCG_FACE);
}

TEST_CASE("an object that moves onto a still finger is met, and carries the god-object") {
  Rig rig;
  const fdcg_finger_id finger = rig.scene.add({0.1, 0.2, 0.7});
  rig.scene.step();
  for (int i = 1; i <= 30; ++i) {
    rig.scene.pose(rig.object, posed({0, 0, 0.01 * i}));
    rig.scene.step();
    const double depth = 0.01 * i - 0.2;
    INFO("tick " << i);
    if (depth > 1e-9) {
      REQUIRE(rig.scene.result(finger).touch_count == 1);
      CHECK(rig.scene.result(finger).force_n[2] == Approx(1000 * depth));
      CHECK(rig.scene.result(finger).touches[0].god_object_m[2] == Approx(0.5 + 0.01 * i));
    } else if (depth < -1e-9) {
      CHECK(rig.scene.result(finger).touch_count == 0);
    }
  }
  // it turns under the finger, which sticks to it
  const fdcg_params rough = contact_params(5, 5);
  REQUIRE(fdcg_scene_set_params(rig.scene.get(), rig.object, &rough, nullptr) == FDCG_OK);
  rig.scene.pose(rig.object, posed({0, 0, 0.3}, {0, 0, 1}, 0.1));
  rig.scene.step();
  const fdcg_finger_result felt = rig.scene.result(finger);
  CHECK(felt.touches[0].god_object_m[0] == Approx(0.1 * std::cos(0.1) - 0.2 * std::sin(0.1)));
  CHECK(felt.touches[0].god_object_m[1] == Approx(0.1 * std::sin(0.1) + 0.2 * std::cos(0.1)));
}

TEST_CASE("one of two objects on one graph moves across a still finger in a tick") {
  Rig rig;
  const fdcg_object_id other = rig.scene.add(rig.mesh.view(), rig.params, posed({10, 0, 0}));
  const fdcg_finger_id finger = rig.scene.add({5, 0.1, 0.2});
  rig.scene.step();
  rig.scene.pose(other, posed({1, 0, 0}));  // past it, over nine sizes
  rig.scene.step();
  const fdcg_finger_result felt = rig.scene.result(finger);
  REQUIRE(felt.touch_count == 1);
  CHECK(felt.touches[0].object.index == other.index);
  CHECK(felt.touches[0].god_object_m[0] == Approx(0.5));
}

TEST_CASE("an object that spins in a tick is not met outside its sphere") {
  Rig rig;
  const fdcg_finger_id finger = rig.scene.add({0.9, 0, 0});
  rig.scene.step();
  rig.scene.pose(rig.object, posed({0, 0, 0}, {0, 0, 1}, 3.1));  // the straight way in its frame leads through it
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 0);
}

TEST_CASE("forces of several objects add up in the order of the objects") {
  Rig rig;
  const fdcg_object_id wall = rig.scene.add(rig.mesh.view(), rig.params, posed({1.02, 0, 1}));  // 20 mm over the rim
  const fdcg_finger_id finger = rig.scene.add({0.45, 0.1, 0.7});
  rig.scene.step();
  rig.scene.move(finger, {0.53, 0.1, 0.49});
  rig.scene.step();
  rig.scene.move(finger, {0.53, 0.1, 0.55});
  rig.scene.step();
  const fdcg_finger_id both = rig.scene.add({0.5, 0.1, 0.6});
  const fdcg_object_id lid = rig.scene.add(rig.mesh.view(), rig.params, posed({0, 0, 1.3}));
  rig.scene.step();
  rig.scene.move(both, {0.49, 0.1, 0.45});
  rig.scene.pose(lid, posed({0, 0, 0.9}));
  rig.scene.step();
  const fdcg_finger_result felt = rig.scene.result(both);
  REQUIRE(felt.touch_count == 2);
  CHECK(felt.touches[0].object.index == rig.object.index);
  CHECK(felt.touches[1].object.index == lid.index);
  for (int k = 0; k < 3; ++k)
    CHECK(felt.force_n[k] == felt.touches[0].force_n[k] + felt.touches[1].force_n[k]);
  CHECK(wall.index == 1);

  std::vector<fdcg_reaction> reactions(3);
  fdcg_scene_get_reactions(rig.scene.get(), reactions.data(), 3);
  const fdcg_touch& touch = felt.touches[1];
  const double arm[3] = {touch.god_object_m[0], touch.god_object_m[1], touch.god_object_m[2] - 0.9};
  for (int k = 0; k < 3; ++k) {
    CHECK(reactions[lid.index].force_n[k] == -touch.force_n[k]);
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    CHECK(reactions[lid.index].torque_n_m[k] == Approx(-(arm[a] * touch.force_n[b] - arm[b] * touch.force_n[a])).margin(1e-12));
  }
}

TEST_CASE("damping acts on the motion against the object") {
  Rig rig;
  fdcg_params damped = rig.params;
  damped.damping_n_s_per_m = 2;
  REQUIRE(fdcg_scene_set_params(rig.scene.get(), rig.object, &damped, nullptr) == FDCG_OK);
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  rig.scene.pose(rig.object, posed({0, 0, 0.002}));  // 2 m/s upwards
  rig.scene.step();
  CHECK(rig.scene.result(finger).force_n[2] == Approx(1000 * 0.012 + 2 * 2));
  const double hip[3] = {0, 0, 0.49};
  CHECK(fdcg_scene_reset_finger(rig.scene.get(), finger, hip, nullptr) == FDCG_OK);
}

TEST_CASE("a NaN HIP moves nothing and is counted") {
  Rig rig;
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  CHECK(rig.scene.result(finger).force_n[2] == Approx(10));
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e101}) {
    rig.scene.move(finger, {0, bad, 0.4});
    rig.scene.step();
    const fdcg_finger_result felt = rig.scene.result(finger);
    CHECK(felt.flags == FDCG_FINGER_NON_FINITE);
    CHECK(felt.force_n[2] == 0);
    REQUIRE(felt.touch_count == 1);
    CHECK(felt.touches[0].force_n[2] == 0);
    CHECK(felt.touches[0].state == FDCG_FACE);
  }
  rig.scene.move(finger, {0, 0, 0.48});
  rig.scene.step();
  CHECK(rig.scene.result(finger).force_n[2] == Approx(20));
  CHECK(rig.scene.result(finger).non_finite_steps == 4);

  // an object that comes while the HIP is unknown is met all the same
  const fdcg_finger_id blind = rig.scene.add({5, 0, 0});
  rig.scene.step();
  rig.scene.move(blind, {kNaN, 0, 0});
  rig.scene.pose(rig.object, posed({4.6, 0, 0}));
  rig.scene.step();
  CHECK(rig.scene.result(blind).touch_count == 1);
  rig.scene.move(blind, {5, 0, 0});
  rig.scene.step();
  CHECK(rig.scene.result(blind).force_n[0] == Approx(100));
}

TEST_CASE("a first HIP of NaN starts no contact") {
  Rig rig;
  const fdcg_finger_id finger = rig.scene.add({kNaN, 0, 0});
  rig.scene.step();
  CHECK(rig.scene.result(finger).flags == FDCG_FINGER_NON_FINITE);
  rig.scene.move(finger, {0, 0, 2});
  rig.scene.step();
  rig.scene.move(finger, {0, 0, 0.49});
  rig.scene.step();
  CHECK(rig.scene.result(finger).force_n[2] == Approx(10));
}

TEST_CASE("a reset finger meets nothing on its way") {
  Rig rig;
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  const double inside[3] = {0, 0, 0.1};
  REQUIRE(fdcg_scene_reset_finger(rig.scene.get(), finger, inside, nullptr) == FDCG_OK);
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 0);
  rig.scene.move(finger, {0, 0, 0.2});
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 0);
}

TEST_CASE("objects that are removed or disabled are released") {
  Rig rig;
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  REQUIRE(fdcg_scene_enable_object(rig.scene.get(), rig.object, 0, nullptr) == FDCG_OK);
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 0);
  REQUIRE(fdcg_scene_enable_object(rig.scene.get(), rig.object, 1, nullptr) == FDCG_OK);
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 0);  // as if just added: the finger is inside
  rig.scene.move(finger, {0, 0, 0.6});
  rig.scene.step();
  rig.scene.move(finger, {0, 0, 0.49});
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 1);
  REQUIRE(fdcg_scene_remove_object(rig.scene.get(), rig.object, nullptr) == FDCG_OK);
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 0);
}

TEST_CASE("an object removed and added again between two steps is new") {
  Rig rig;
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  REQUIRE(fdcg_scene_enable_object(rig.scene.get(), rig.object, 0, nullptr) == FDCG_OK);
  REQUIRE(fdcg_scene_enable_object(rig.scene.get(), rig.object, 1, nullptr) == FDCG_OK);
  rig.scene.step();
  CHECK(rig.scene.result(finger).touch_count == 0);
}

// The contact's feature is one of hundreds, and the other object has a dozen.
TEST_CASE("an object that takes the index of one removed between two steps does not get its contacts") {
  const CompiledMesh large(ico_sphere(3)), small(ico_sphere(0));
  SceneRig scene(fdcg_make_scene_config());
  const fdcg_params params = fdcg_make_params();
  const fdcg_object_id before = scene.add(large.view(), params, posed({0, 0, 0}));
  std::vector<fdcg_finger_id> fingers;
  for (double x = -0.6; x < 0.7; x += 0.2)
    fingers.push_back(scene.add({x, 0.1, 2}));
  scene.step();
  for (std::size_t f = 0; f < fingers.size(); ++f)
    scene.move(fingers[f], {-0.6 + 0.2 * static_cast<double>(f), 0.1, 0.5});
  scene.step();
  for (const fdcg_finger_id finger : fingers)
    REQUIRE(scene.result(finger).touch_count == 1);
  REQUIRE(fdcg_scene_remove_object(scene.get(), before, nullptr) == FDCG_OK);
  const fdcg_object_id after = scene.add(small.view(), params, posed({0, 0, 0}));
  CHECK(after.index == before.index);
  scene.step();
  for (const fdcg_finger_id finger : fingers)
    CHECK(scene.result(finger).touch_count == 0);
}

TEST_CASE("ids of removed objects stay invalid") {
  Rig rig;
  fdcg_error error = {};
  REQUIRE(fdcg_scene_remove_object(rig.scene.get(), rig.object, &error) == FDCG_OK);
  const fdcg_object_id again = rig.scene.add(rig.mesh.view(), rig.params, posed({0, 0, 0}));
  CHECK(again.index == rig.object.index);
  CHECK(again.generation != rig.object.generation);
  CHECK(fdcg_scene_remove_object(rig.scene.get(), rig.object, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, Equals("object: not in this scene, or removed"));
  const fdcg_finger_id finger = rig.scene.add({0, 0, 0});
  REQUIRE(fdcg_scene_remove_finger(rig.scene.get(), finger, &error) == FDCG_OK);
  const double hip[3] = {};
  CHECK(fdcg_scene_move_finger(rig.scene.get(), finger, hip, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, Equals("finger: not in this scene, or removed"));
  CHECK(fdcg_scene_step_finger(rig.scene.get(), {0, 0}, nullptr) == FDCG_E_ARGUMENT);
}

TEST_CASE("added objects get the lowest free index") {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.finger_capacity = 4;
  Rig rig(config);
  fdcg_scene* const scene = rig.scene.get();
  fdcg_error error = {};
  fdcg_finger_id fingers[4], again;
  const double hip[3] = {0, 0, 3};
  for (std::uint32_t i = 0; i < 4; ++i) {
    REQUIRE(fdcg_scene_add_finger(scene, hip, &fingers[i], &error) == FDCG_OK);
    CHECK(fingers[i].index == i);
  }
  CHECK(fdcg_scene_add_finger(scene, hip, &again, &error) == FDCG_E_ARGUMENT);
  for (const std::uint32_t i : {2u, 1u, 3u})
    REQUIRE(fdcg_scene_remove_finger(scene, fingers[i], &error) == FDCG_OK);
  for (const std::uint32_t i : {1u, 2u, 3u}) {
    REQUIRE(fdcg_scene_add_finger(scene, hip, &again, &error) == FDCG_OK);
    CHECK(again.index == i);
  }
  CHECK(fdcg_scene_add_finger(scene, hip, &again, &error) == FDCG_E_ARGUMENT);
}

TEST_CASE("a bad pose is refused with its reason, and the old one stays") {
  Rig rig;
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  fdcg_pose pose = posed({0, 0, 0});
  pose.rotation_xyzw[0] = 0.1;
  CHECK_THAT(refusal_of(rig, pose), Equals("pose.rotation_xyzw's length is 1.004988, allowed 0.999 to 1.001"));
  pose = {};
  CHECK_THAT(refusal_of(rig, pose), Equals("pose.rotation_xyzw's length is 0, allowed 0.999 to 1.001"));
  pose = posed({0, kNaN, 0});
  CHECK_THAT(refusal_of(rig, pose), Equals("pose.translation_m[1] is NaN, allowed -1e12 to 1e12"));
  pose = posed({0, 0, -1e13});
  CHECK_THAT(refusal_of(rig, pose), Equals("pose.translation_m[2] is -1e13, allowed -1e12 to 1e12"));
  for (const double scale : {0.0, -1.0, kInfinity, kNaN}) {
    pose = posed({0, 0, 0});
    pose.scale = scale;
    CHECK_THAT(refusal_of(rig, pose), ContainsSubstring("pose.scale is ") && ContainsSubstring(", allowed 1e-9 to 1e9"));
  }
  rig.scene.step();
  CHECK(rig.scene.result(finger).force_n[2] == Approx(10));
  // nearly unit is made unit
  pose = posed({0, 0, 0});
  pose.rotation_xyzw[3] = 0.9995;
  rig.scene.pose(rig.object, pose);
  rig.scene.step();
  CHECK(rig.scene.result(finger).force_n[2] == 1000 * (0.5 - 0.49));
}

TEST_CASE("a config out of range is refused with its reason") {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.object_capacity = 0;
  CHECK_THAT(refusal_of(config), Equals("config.object_capacity is 0, allowed 1 to 1e6"));
  config = fdcg_make_scene_config();
  config.touches_per_finger = 33;
  CHECK_THAT(refusal_of(config), Equals("config.touches_per_finger is 33, allowed 1 to 32"));
  config = fdcg_make_scene_config();
  config.disabled_optimizations = 32;
  CHECK_THAT(refusal_of(config), Equals("config.disabled_optimizations is 32, allowed 0 to 31"));
  config = fdcg_make_scene_config();
  config.struct_bytes = 0;
  CHECK_THAT(refusal_of(config), ContainsSubstring("config.struct_bytes is 0") && ContainsSubstring("fdcg_make_scene_config"));
  // a program built against a shorter struct: missing fields have their defaults
  config = fdcg_make_scene_config();
  config.struct_bytes = 8;
  config.touches_per_finger = 99;
  CHECK(fdcg_scene_bytes(&config) > 0);
}

TEST_CASE("memory that is too small or badly placed is refused") {
  const fdcg_scene_config config = fdcg_make_scene_config();
  const std::uint64_t bytes = fdcg_scene_bytes(&config);
  std::vector<std::uint64_t> memory(bytes / 8 + 2);
  fdcg_scene* scene = nullptr;
  fdcg_error error = {};
  CHECK(fdcg_scene_create(memory.data(), bytes - 1, &config, &scene, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message,
             ContainsSubstring("bytes is " + std::to_string(bytes - 1)) && ContainsSubstring(std::to_string(bytes)));
  CHECK(fdcg_scene_create(reinterpret_cast<char*>(memory.data()) + 4, bytes, &config, &scene, &error) == FDCG_E_ALIGNMENT);
  CHECK(fdcg_scene_create(nullptr, bytes, &config, &scene, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_scene_create(memory.data(), bytes, &config, &scene, nullptr) == FDCG_OK);
  // nothing is written behind what was asked for, whatever the memory held before
  std::fill(memory.begin(), memory.end(), 0xA5A5A5A5A5A5A5A5u);
  REQUIRE(fdcg_scene_create(memory.data(), bytes, &config, &scene, &error) == FDCG_OK);
  const CompiledMesh mesh(cube());
  const fdcg_params params = contact_params(0.5, 0.4);
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_object_id object;
  fdcg_finger_id finger;
  const double above[3] = {0, 0, 0.6}, below[3] = {0, 0, 0.49};
  for (std::uint32_t i = 0; i < config.object_capacity; ++i)
    REQUIRE(fdcg_scene_add_object(scene, &mesh.view(), &params, &pose, &object, &error) == FDCG_OK);
  CHECK(fdcg_scene_add_object(scene, &mesh.view(), &params, &pose, &object, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, Equals("config.object_capacity is 64, and as many are in the scene"));
  for (std::uint32_t i = 0; i < config.finger_capacity; ++i)
    REQUIRE(fdcg_scene_add_finger(scene, above, &finger, &error) == FDCG_OK);
  CHECK(fdcg_scene_add_finger(scene, above, &finger, &error) == FDCG_E_ARGUMENT);
  fdcg_scene_step(scene);
  for (std::uint32_t i = 0; i < config.finger_capacity; ++i)
    fdcg_scene_move_finger(scene, {i, finger.generation}, below, &error);
  fdcg_scene_step(scene);
  fdcg_finger_result felt;
  REQUIRE(fdcg_scene_get_result(scene, finger, &felt, &error) == FDCG_OK);
  CHECK(felt.touch_count == config.touches_per_finger);
  CHECK(felt.flags == FDCG_FINGER_CONTACT_OVERFLOW);
  CHECK(felt.overflowed_steps == 1);
  CHECK(memory[bytes / 8] == 0xA5A5A5A5A5A5A5A5u);
  CHECK(memory[bytes / 8 + 1] == 0xA5A5A5A5A5A5A5A5u);
}

TEST_CASE("with too few slots touched objects keep theirs, and the nearest get the others") {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.touches_per_finger = 2;
  Rig rig(config);
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  // three more that close in from the sides in one tick; the middle of the second comes nearest
  const double ends[] = {0.97, 0.90, 0.95};
  std::vector<fdcg_object_id> others;
  for (int i = 0; i < 3; ++i)
    others.push_back(rig.scene.add(rig.mesh.view(), rig.params, posed({3.0 + i, 0, 0.49})));
  rig.scene.step();
  CHECK(rig.scene.result(finger).flags == 0);
  for (std::size_t i = 0; i < 3; ++i)
    rig.scene.pose(others[i], posed({0.4 * ends[i], 0, 0.49}));
  rig.scene.step();
  const fdcg_finger_result felt = rig.scene.result(finger);
  CHECK(felt.flags == FDCG_FINGER_CONTACT_OVERFLOW);
  REQUIRE(felt.touch_count == 2);
  CHECK(felt.touches[0].object.index == rig.object.index);
  CHECK(felt.touches[1].object.index == others[1].index);
}

TEST_CASE("a copy of a scene's memory is independent") {
  Rig rig;
  const fdcg_finger_id finger = rig.pressing({0, 0, 0.49});
  std::vector<std::uint64_t> copy = rig.scene.memory();
  auto* const other = reinterpret_cast<fdcg_scene*>(copy.data());
  std::memset(rig.scene.memory().data(), 0xEE, rig.scene.memory().size() * 8);
  const double hip[3] = {0, 0, 0.48};
  REQUIRE(fdcg_scene_move_finger(other, finger, hip, nullptr) == FDCG_OK);
  fdcg_scene_step(other);
  fdcg_finger_result felt;
  REQUIRE(fdcg_scene_get_result(other, finger, &felt, nullptr) == FDCG_OK);
  CHECK(felt.force_n[2] == Approx(20));
  CHECK(felt.touches >= static_cast<void*>(copy.data()));
  CHECK(felt.touches < static_cast<void*>(copy.data() + copy.size()));
}

TEST_CASE("a finger may be stepped several times in a tick, and missed ticks are reported") {
  Rig rig;
  const fdcg_finger_id finger = rig.scene.add({0, 0, 0.7});
  fdcg_scene* const scene = rig.scene.get();
  fdcg_scene_advance(scene);
  REQUIRE(fdcg_scene_step_finger(scene, finger, nullptr) == FDCG_OK);
  rig.scene.pose(rig.object, posed({0, 0, 0.1}));
  fdcg_scene_advance(scene);
  for (const double z : {0.65, 0.62, 0.59, 0.58}) {  // the top is at 0.6 now
    rig.scene.move(finger, {0, 0, z});
    REQUIRE(fdcg_scene_step_finger(scene, finger, nullptr) == FDCG_OK);
    CHECK(rig.scene.result(finger).force_n[2] == Approx(std::max(0.0, 1000 * (0.6 - z))).margin(1e-9));
    CHECK(rig.scene.result(finger).flags == 0);
  }
  fdcg_scene_advance(scene);
  fdcg_scene_advance(scene);
  fdcg_scene_advance(scene);
  REQUIRE(fdcg_scene_step_finger(scene, finger, nullptr) == FDCG_OK);
  CHECK(rig.scene.result(finger).flags == FDCG_FINGER_MISSED_TICK);
  CHECK(rig.scene.result(finger).missed_ticks == 2);
  CHECK(rig.scene.result(finger).force_n[2] == Approx(20));
}

TEST_CASE("fingers stepped on threads give the same forces as sequentially") {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.finger_capacity = 16;
  Rig one(config), many(config);
  std::vector<fdcg_finger_id> fingers, others;
  for (std::uint32_t i = 0; i < config.finger_capacity; ++i) {
    fingers.push_back(one.scene.add({-0.6 + 0.07 * i, 0, 0.52}));
    others.push_back(many.scene.add({-0.6 + 0.07 * i, 0, 0.52}));
  }
  const auto hip = [](std::uint32_t finger, int tick) {
    return Place{-0.6 + 0.07 * finger, 0.001 * tick, 0.5 + 0.02 * std::sin(0.3 * tick + finger)};
  };
  for (int tick = 0; tick < 50; ++tick) {
    const fdcg_pose pose = posed({0, 0, 0.01 * std::sin(0.2 * tick)}, {0, 0, 1}, 0.01 * tick);
    one.scene.pose(one.object, pose);
    many.scene.pose(many.object, pose);
    for (std::uint32_t i = 0; i < config.finger_capacity; ++i)
      one.scene.move(fingers[i], hip(i, tick));
    one.scene.step();
    fdcg_scene_advance(many.scene.get());
    const auto work = [&](std::uint32_t first) {
      for (std::uint32_t i = first; i < config.finger_capacity; i += 2) {
        const Place at = hip(i, tick);
        fdcg_scene_move_finger(many.scene.get(), others[i], at.data(), nullptr);
        fdcg_scene_step_finger(many.scene.get(), others[i], nullptr);
      }
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    for (std::size_t i = 0; i < fingers.size(); ++i) {
      REQUIRE(std::memcmp(one.scene.result(fingers[i]).force_n, many.scene.result(others[i]).force_n, sizeof(double[3])) == 0);
    }
  }
}

TEST_CASE("out of reach the broad phase is skipped for any number of objects") {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.object_capacity = 1000;
  Rig rig(config);
  for (int i = 1; i < 1000; ++i)
    rig.scene.add(rig.mesh.view(), rig.params, posed({3.0 * (i % 10), 3.0 * (i / 10 % 10), 3.0 * (i / 100)}));
  const fdcg_finger_id finger = rig.scene.add({-10, 0, 0});
  for (int i = 0; i < 9000; ++i) {  // 1 mm a tick, up to 1 m from the nearest bounds
    rig.scene.move(finger, {-10 + 0.001 * i * 8 / 9, 0, 0});
    rig.scene.step();
  }
  CHECK(rig.scene.result(finger).broadphase_updates < 10);
}

TEST_CASE("a scene never uses the heap") {
  if (!can_count_heap_calls()) return;
  const fdcg_scene_config config = fdcg_make_scene_config();
  const CompiledMesh mesh(star_sphere(2, 0.3, 5));
  std::vector<std::uint64_t> memory(fdcg_scene_bytes(&config) / 8 + 1);
  const std::uint64_t before = heap_calls();
  fdcg_scene* scene = nullptr;
  fdcg_error error;
  fdcg_object_id objects[3];
  fdcg_finger_id fingers[2];
  fdcg_reaction reactions[3];
  fdcg_finger_result felt;
  const fdcg_params params = fdcg_make_params();
  std::uint32_t touches = 0;
  fdcg_status status = fdcg_scene_create(memory.data(), memory.size() * 8, &config, &scene, &error);
  for (fdcg_object_id& object : objects) {
    const fdcg_pose pose = fdcg_make_identity_pose();
    if (status == FDCG_OK) status = fdcg_scene_add_object(scene, &mesh.view(), &params, &pose, &object, &error);
  }
  const double far[3] = {5, 0, 0};
  for (fdcg_finger_id& finger : fingers) {
    if (status == FDCG_OK) status = fdcg_scene_add_finger(scene, far, &finger, &error);
  }
  for (int tick = 0; tick < 2000 && status == FDCG_OK; ++tick) {
    const double swing = 0.02 * tick;
    for (int i = 0; i < 3; ++i) {
      const fdcg_pose pose = posed({i * 1.5, 0.5 * std::sin(swing), 0}, {0, 0, 1}, 0.1 * swing);
      fdcg_scene_set_pose(scene, objects[i], &pose, &error);
    }
    for (int i = 0; i < 2; ++i) {
      const double hip[3] = {tick % 500 == 7 ? kNaN : 1.5 + 3 * std::cos(0.7 * swing + i), 0.2 * std::sin(swing), 0.1};
      fdcg_scene_move_finger(scene, fingers[i], hip, &error);
    }
    fdcg_scene_step(scene);
    for (const fdcg_finger_id finger : fingers) {
      if (fdcg_scene_get_result(scene, finger, &felt, &error) == FDCG_OK) touches += felt.touch_count;
    }
    fdcg_scene_get_reactions(scene, reactions, 3);
    if (tick == 1000) status = fdcg_scene_remove_object(scene, objects[2], &error);
  }
  const std::uint64_t calls = heap_calls() - before;
  CHECK(status == FDCG_OK);
  CHECK(touches > 100);
  CHECK(calls == 0);
}

TEST_CASE("the C++ scene does what the C functions do") {
  const fdcg_scene_config config = fdcg_make_scene_config();
  std::vector<std::byte> memory(fdcg::Scene::bytes(config));
  const auto compiled = fdcg::bake::compile(cube(), {});
  fdcg::Graph graph;
  fdcg_error why = {};
  REQUIRE(graph.open_memory(std::as_bytes(std::span(compiled->bytes)), &why));
  fdcg::Scene scene;
  REQUIRE(scene.create(memory, config, &why));
  fdcg_object_id object;
  fdcg_finger_id finger;
  const double above[3] = {0, 0, 0.6}, below[3] = {0, 0, 0.49};
  REQUIRE(scene.add_object(graph, contact_params(0, 0), fdcg_make_identity_pose(), &object, &why));
  REQUIRE(scene.add_finger(above, &finger, &why));
  scene.step();
  REQUIRE(scene.move(finger, below));
  scene.advance();
  REQUIRE(scene.step(finger));
  REQUIRE(scene.touches(finger).size() == 1);
  CHECK(scene.result(finger).force_n[2] == Approx(10));
  fdcg_reaction reaction[1];
  scene.reactions(reaction);
  CHECK(reaction[0].force_n[2] == Approx(-10));
  REQUIRE(scene.set_pose(object, posed({0, 0, -1}), &why));
  REQUIRE(scene.set_params(object, contact_params(1, 1), &why));
  REQUIRE(scene.enable(object, false));
  REQUIRE(scene.reset(finger, above));
  scene.step();
  CHECK(scene.touches(finger).empty());
  REQUIRE(scene.remove(finger));
  REQUIRE(scene.remove(object));
  CHECK_FALSE(scene.remove(object, &why));
  CHECK(scene.result(finger).touch_count == 0);
}
