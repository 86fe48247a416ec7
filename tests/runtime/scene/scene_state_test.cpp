// SPDX-License-Identifier: Apache-2.0
// A scene's state as bytes: what goes on from it goes on bit for bit, and bytes that are no state of the scene change nothing.
#include <cstring>

#include "fdcg/deform.h"
#include "fdcg/soft_finger.h"
#include "fdcg/surface.h"
#include "scene_play.hpp"

using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

// Changes bytes of a state and makes its checksum fit.
void seal(std::vector<std::uint64_t>* state) {
  (*state)[3] = fdcg_checksum(state->data() + 4, state->size() * 8 - 32);
}

fdcg_params with_curve(const fdcg_material* materials, std::uint32_t count) {
  fdcg_params params = fdcg_make_params();
  params.friction_flags = FDCG_FRICTION_ALL & ~FDCG_FRICTION_FINGER;
  params.materials = materials;
  params.material_count = count;
  return params;
}

// Objects of all kinds that a state knows, and soft fingers that press, turn and slide on them.
class Workshop {
 public:
  explicit Workshop(const PlayMeshes& meshes) : scene(config()) {
    const fdcg_material materials[] = {{0.7, 0.5, 900}, {0.3, 0.2, 400}};
    objects.push_back(scene.add(*meshes.graphs[0], with_curve(materials, 2), posed({0, 0, 0})));
    objects.push_back(scene.add(*meshes.graphs[5], contact_params(0.5, 0.3), posed({3, 0, 0}, {0, 0, 1}, 0.3, 0.7)));
    const fdcg_surface surfaces[] = {fdcg_make_plane(),
                                     fdcg_make_sphere(0.5),
                                     fdcg_make_cylinder(0.5, 1),
                                     fdcg_make_capsule(0.3, 1),
                                     fdcg_make_box(0.5, 0.5, 0.5),
                                     fdcg_make_cone(0.5, 0.2, 1),
                                     fdcg_make_torus(0.5, 0.2),
                                     fdcg_make_ellipsoid(0.5, 0.4, 0.3)};
    for (const fdcg_surface& surface : surfaces) {
      fdcg_object_id id;
      const fdcg_params params = contact_params(0.6, 0.4);
      const fdcg_pose pose =
          posed({3.0 * static_cast<double>(objects.size()), 0, surface.kind == FDCG_SURFACE_PLANE ? -1.0 : 0});
      REQUIRE(fdcg_scene_add_surface(scene.get(), &surface, &params, &pose, &id, nullptr) == FDCG_OK);
      objects.push_back(id);
    }
  }

  void add_fingers() {
    const fdcg_material rubber = {0.9, 0.8, 700};
    for (std::size_t i = 0; i < objects.size(); ++i) {
      fingers.push_back(scene.add({3.0 * static_cast<double>(i), 0, 1}));
      if (i % 2 == 0) REQUIRE(fdcg_scene_set_finger_radius(scene.get(), fingers.back(), 0.01, nullptr) == FDCG_OK);
      if (i % 3 == 0) REQUIRE(fdcg_scene_set_finger_material(scene.get(), fingers.back(), &rubber, nullptr) == FDCG_OK);
    }
  }

  // What all fingers feel in the ticks from `begin` to `end`.
  std::vector<double> play(int begin, int end) {
    std::vector<double> felt;
    for (int tick = begin; tick < end; ++tick) {
      scene.pose(objects[1], posed({3 + 0.001 * (tick % 50), 0, 0}, {0, 0, 1}, 0.3 + 0.002 * tick, 0.7));
      for (std::size_t i = 0; i < fingers.size(); ++i) {
        const double around = 0.02 * tick + static_cast<double>(i), deep = 1 - 0.7 * std::sin(0.011 * tick);
        scene.move(fingers[i], {3.0 * static_cast<double>(i) + 0.3 * std::cos(around), 0.3 * std::sin(around), deep});
        const fdcg_pose turn = posed({0, 0, 0}, {0, 0, 1}, 0.01 * (tick % 40));
        REQUIRE(fdcg_scene_set_finger_rotation(scene.get(), fingers[i], turn.rotation_xyzw, nullptr) == FDCG_OK);
      }
      scene.step();
      for (const fdcg_finger_id finger : fingers) {
        const fdcg_finger_result result = scene.result(finger);
        double torque[3];
        REQUIRE(fdcg_scene_get_finger_torque(scene.get(), finger, torque, nullptr) == FDCG_OK);
        felt.insert(felt.end(), result.force_n, result.force_n + 3);
        felt.insert(felt.end(), torque, torque + 3);
        felt.push_back(result.touch_count);
      }
    }
    return felt;
  }

  static fdcg_scene_config config() {
    fdcg_scene_config config = fdcg_make_scene_config();
    config.object_capacity = 12;
    config.finger_capacity = 12;
    config.has_soft_fingers = 1;
    return config;
  }

  SceneRig scene;
  std::vector<fdcg_object_id> objects;
  std::vector<fdcg_finger_id> fingers;
};

fdcg_status restored(SceneRig& scene, const std::vector<std::uint64_t>& state, fdcg_error* error) {
  error->message[0] = '\0';
  return fdcg_scene_restore(scene.get(), state.data(), state.size() * 8, error);
}

}  // namespace

TEST_CASE("a play that goes on in other scenes again and again feels the same bits") {
  const Place here = {0, 0, 0};
  const Play plays[] = {{1, 1, 4, 3, 0.2, 0, here, false, false},
                        {40, 3, 2, 2, 0.1, 0.5, here, true, true},
                        {150, 8, 8, 9, 0.3, 1, here, true, true},
                        {20, 2, 4, 4, 0.1, 0.5, {1e6, -2e6, 3e5}, false, true}};
  const PlayMeshes meshes;
  std::uint64_t touches = 0;
  for (const Play& play : plays) {
    const std::size_t ticks = ticks_of_a_run(play.objects > 100 ? 300 : 1500);
    const Outcome whole = Performance(play, meshes.graphs, 0, 7).run(ticks);
    const Outcome moved = Performance(play, meshes.graphs, 0, 7).run(ticks, 7);
    CHECK(moved.hash == whole.hash);
    touches += whole.touches;
  }
  CHECK(touches > 1000);
}

TEST_CASE("surfaces, soft fingers, materials and the friction curve go on from a state") {
  const PlayMeshes meshes;
  Workshop whole(meshes), other(meshes);
  whole.add_fingers();
  whole.play(0, 150);
  const std::vector<std::uint64_t> state = saved_state(whole.scene.get());
  const std::vector<double> felt = whole.play(150, 400);
  fdcg_error error;
  REQUIRE(restored(other.scene, state, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("fdcg_scene_set_finger_radius"));
  const fdcg_finger_id soft = other.scene.add({0, 0, 5});
  REQUIRE(fdcg_scene_set_finger_radius(other.scene.get(), soft, 0.01, nullptr) == FDCG_OK);
  INFO(error.message);
  REQUIRE(restored(other.scene, state, &error) == FDCG_OK);
  other.objects = whole.objects;  // ids are those of the state
  other.fingers = whole.fingers;
  const bool goes_on = other.play(150, 400) == felt;
  CHECK(goes_on);
  double touched = 0;
  for (std::size_t i = 6; i < felt.size(); i += 7)
    touched += felt[i];
  CHECK(touched > 100);
  REQUIRE(restored(whole.scene, state, &error) == FDCG_OK);  // back in the scene itself
  const bool goes_back = whole.play(150, 400) == felt;
  CHECK(goes_back);
}

TEST_CASE("what was added after a state was saved is gone, and new ids are those of the first time") {
  const PlayMeshes meshes;
  SceneRig scene(fdcg_make_scene_config());
  const fdcg_object_id cube = scene.add(*meshes.graphs[0], contact_params(0.5, 0.3), posed({0, 0, 0}));
  const fdcg_finger_id first = scene.add({0, 0, 2});
  scene.step();
  const std::vector<std::uint64_t> state = saved_state(scene.get());
  const fdcg_finger_id second = scene.add({0, 0, 3});
  fdcg_error error;
  REQUIRE(restored(scene, state, &error) == FDCG_OK);
  fdcg_finger_result result;
  CHECK(fdcg_scene_get_result(scene.get(), second, &result, &error) == FDCG_E_ARGUMENT);
  const fdcg_finger_id again = scene.add({0, 0, 3});
  CHECK((again.index == second.index && again.generation == second.generation));
  CHECK(scene.result(first).touch_count == 0);
  const fdcg_object_id more = scene.add(*meshes.graphs[1], contact_params(0.5, 0.3), posed({5, 0, 0}));
  REQUIRE(restored(scene, state, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("object 1 is in the scene and not in the state"));
  REQUIRE(fdcg_scene_remove_object(scene.get(), more, &error) == FDCG_OK);
  CHECK(restored(scene, state, &error) == FDCG_OK);
  REQUIRE(fdcg_scene_remove_object(scene.get(), cube, &error) == FDCG_OK);
  REQUIRE(restored(scene, state, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("object 0 is in the state and not in the scene"));
  scene.add(*meshes.graphs[2], contact_params(0.5, 0.3), posed({0, 0, 0}));
  REQUIRE(restored(scene, state, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("object 0 has another graph"));
}

TEST_CASE("bytes that are no state are refused by name, and too little room too") {
  const PlayMeshes meshes;
  SceneRig scene(fdcg_make_scene_config());
  scene.add(*meshes.graphs[0], contact_params(0.5, 0.3), posed({0, 0, 0}));
  scene.add({0, 0, 2});
  fdcg_error error;
  const std::vector<std::uint64_t> state = saved_state(scene.get());
  const std::uint64_t bytes = state.size() * 8;
  const auto with_word = [&](std::size_t word, std::uint64_t value) {
    std::vector<std::uint64_t> changed = state;
    changed[word] = value;
    return restored(scene, changed, &error);
  };
  CHECK(with_word(0, 1) == FDCG_E_MAGIC);
  CHECK(with_word(1, 1) == FDCG_E_VERSION);
  CHECK(with_word(2, bytes + 8) == FDCG_E_TRUNCATED);
  CHECK(with_word(20, state[20] ^ 1) == FDCG_E_CHECKSUM);
  CHECK(fdcg_scene_restore(scene.get(), state.data(), bytes - 8, &error) == FDCG_E_TRUNCATED);
  CHECK(fdcg_scene_restore(scene.get(), state.data(), 16, &error) == FDCG_E_TRUNCATED);
  CHECK(fdcg_scene_restore(scene.get(), reinterpret_cast<const char*>(state.data()) + 4, bytes - 8, &error) ==
        FDCG_E_ALIGNMENT);
  CHECK(fdcg_scene_restore(nullptr, state.data(), bytes, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_scene_restore(scene.get(), nullptr, bytes, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_scene_state_bytes(nullptr) == 0);
  std::vector<std::uint64_t> room = state;
  CHECK(fdcg_scene_save(scene.get(), room.data(), bytes - 8, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("state needs"));
  CHECK(fdcg_scene_save(scene.get(), reinterpret_cast<char*>(room.data()) + 4, bytes, &error) == FDCG_E_ALIGNMENT);
  CHECK(fdcg_scene_save(scene.get(), nullptr, bytes, &error) == FDCG_E_ARGUMENT);
  fdcg_scene_config small = fdcg_make_scene_config();
  small.touches_per_finger = 3;
  SceneRig other(small);
  CHECK(restored(other, state, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("config.touches_per_finger is 3, in the state 4"));
}

TEST_CASE("forged bytes are refused, or step without undefined behaviour; what is refused changes nothing") {
  const Play play = {6, 3, 2, 2, 0.1, 0.5, {0, 0, 0}, true, true};
  const PlayMeshes meshes;
  Performance performance(play, meshes.graphs, 0, 3);
  performance.run(200);
  std::vector<std::uint64_t> state;
  for (int tries = 0; tries < 200 && (tries == 0 || state[5] >> 32 == 0 || state[6] == 0); ++tries) {
    performance.run(1);
    state = saved_state(performance.scene().get());
  }
  Random random(11);
  std::unique_ptr<SceneRig> scene = performance.another_scene();
  int taken = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint64_t> forged = state;
    const std::uint64_t values[] = {
        0, 1, 2, ~std::uint64_t{0}, 0x7FF8000000000000u, 0x7FEFFFFFFFFFFFFFu, random.below(1u << 20), forged[4] ^ 1};
    const std::size_t word = 4 + random.below(static_cast<std::uint32_t>(forged.size() - 4));
    const std::uint64_t value = values[random.below(8)];
    const std::uint64_t mask = random.chance(0.5) ? ~std::uint64_t{0} : random.chance(0.5) ? 0xFFFFFFFFu : 0xFFFFFFFF00000000u;
    forged[word] = (forged[word] & ~mask) | (value & mask);
    seal(&forged);
    const std::vector<std::uint64_t> before = saved_state(scene->get());
    fdcg_error error;
    if (restored(*scene, forged, &error) == FDCG_OK) {
      ++taken;
      for (int tick = 0; tick < 3; ++tick)
        scene->step();
      scene = performance.another_scene();
    } else {
      ++refused;
      CHECK(std::strlen(error.message) > 10);
      const bool is_as_before = saved_state(scene->get()) == before;
      CHECK(is_as_before);
    }
  }
  CHECK(taken > 1000);
  CHECK(refused > 1000);
}

TEST_CASE("the byte form is where its page says") {  // docs/internals/scene-state.md
  const PlayMeshes meshes;
  SceneRig scene(fdcg_make_scene_config());
  scene.add(*meshes.graphs[0], contact_params(0.5, 0.3), posed({0, 0, 0}));
  const fdcg_finger_id finger = scene.add({0.1, 0.2, 2});
  scene.step();
  scene.move(finger, {0.1, 0.2, 0.4});
  scene.step();
  const fdcg_finger_result felt = scene.result(finger);
  REQUIRE(felt.touch_count == 1);
  const std::vector<std::uint64_t> state = saved_state(scene.get());
  const auto* const bytes = reinterpret_cast<const unsigned char*>(state.data());
  const auto word = [&](std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, bytes + at, sizeof value);
    return value;
  };
  const auto real = [&](std::size_t at) {
    double value;
    std::memcpy(&value, bytes + at, sizeof value);
    return value;
  };
  CHECK(std::memcmp(bytes, "FDCGSTAT", 8) == 0);
  CHECK(word(8) == 2);
  CHECK((word(32) == 1 && word(36) == 0 && word(40) == 1 && word(44) == 1 && word(48) == 1));  // counts
  CHECK(state.size() * 8 == 72 + 432 + 208 + 432 + 80);
  CHECK(real(72 + 40) == 0.5);              // mu_static
  CHECK(real(72 + 432 + 40 + 16) == 0.4);   // the HIP's z
  const std::size_t held = 72 + 432 + 208;  // slot, object, contact
  CHECK(real(held + 8 + 16) == Approx(0.5));
  CHECK(word(held + 8 + 52) == FDCG_FACE);
  CHECK(real(held + 432 + 8 + 16) == felt.force_n[2]);
}

TEST_CASE("a scene with a deformable mesh is not saved, with the reason") {
  fdcg::bake::CompileOptions options;
  options.triangles = true;
  const CompiledMesh mesh(cube(), options);
  std::vector<std::uint64_t> memory(fdcg_deform_bytes(&mesh.view()) / 8 + 1);
  fdcg_deform* deform = nullptr;
  fdcg_error error;
  const fdcg_deform_config deform_config = fdcg_make_deform_config();
  REQUIRE(fdcg_deform_create(memory.data(), memory.size() * 8, &mesh.view(), &deform_config, &deform, &error) == FDCG_OK);
  fdcg_scene_config config = fdcg_make_scene_config();
  config.has_deforms = 1;
  SceneRig scene(config);
  const fdcg_params params = contact_params(0.5, 0.3);
  const fdcg_pose pose = posed({0, 0, 0});
  fdcg_object_id id;
  REQUIRE(fdcg_scene_add_deform(scene.get(), deform, &params, &pose, &id, &error) == FDCG_OK);
  std::vector<std::uint64_t> state(fdcg_scene_state_bytes(scene.get()) / 8);
  CHECK(fdcg_scene_save(scene.get(), state.data(), state.size() * 8, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("object 0 is a deformable mesh"));
}
