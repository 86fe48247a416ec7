// SPDX-License-Identifier: Apache-2.0
// A scene's own copies of materials' tables: what the caller does to its tables afterwards does not count.
#include <cstring>
#include <memory>
#include <vector>

#include "compiled.hpp"
#include "meshes.hpp"
#include "scene_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

// A cube whose top, and one side, have materials.
class TwoMaterials {
 public:
  TwoMaterials() {
    bake::PolygonSoup soup = cube();
    soup.materials = {"rubber", "ice"};
    soup.face_material.assign(soup.face_count(), 1);
    for (std::size_t f = 0; f < soup.face_count(); ++f) {
      bool is_top = true;
      for (const std::uint32_t corner : face_corners(soup, f))
        is_top = is_top && soup.points[corner].z > 0;
      if (is_top) soup.face_material[f] = 0;
    }
    compiled_ = compile_whole(soup);
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled_.bytes.data(), compiled_.bytes.size(), FDCG_VERIFY_SAFE, &graph, &error) == FDCG_OK);
  }
  fdcg_graph graph{};

 private:
  bake::Compiled compiled_;
};

fdcg_params params_of(const std::vector<fdcg_material>& table) {
  fdcg_params params = fdcg_make_params();
  params.friction_flags = FDCG_FRICTION_MATERIALS;
  params.materials = table.data();
  params.material_count = static_cast<std::uint32_t>(table.size());
  return params;
}

// The force 10 mm below the top of the cube at a place.
double pressed(SceneRig& rig, double x) {
  const fdcg_finger_id finger = rig.add({x, 0, 0.6});
  rig.step();
  rig.move(finger, {x, 0, 0.49});
  rig.step();
  const double force = rig.result(finger).force_n[2];
  fdcg_error error;
  REQUIRE(fdcg_scene_remove_finger(rig.get(), finger, &error) == FDCG_OK);
  return force;
}

}  // namespace

TEST_CASE("a scene feels the materials that it was given, not what became of the table") {
  const TwoMaterials cube;
  SceneRig rig(fdcg_make_scene_config());
  auto table = std::make_unique<std::vector<fdcg_material>>(std::vector<fdcg_material>{{0.3, 0.2, 500}, {0.9, 0.7, 900}});
  rig.add(cube.graph, params_of(*table), posed({0, 0, 0}));
  CHECK(pressed(rig, 0) == Approx(5));
  (*table)[0].stiffness_n_per_m = 100;
  CHECK(pressed(rig, 0) == Approx(5));
  table.reset();
  CHECK(pressed(rig, 0) == Approx(5));
}

TEST_CASE("tables come and go, and each object keeps its own") {
  const TwoMaterials cube;
  fdcg_scene_config config = fdcg_make_scene_config();
  config.material_capacity = 6;
  SceneRig rig(config);
  std::vector<fdcg_object_id> objects;
  std::vector<double> stiffness = {100, 200, 300};
  for (std::size_t i = 0; i < 3; ++i)
    objects.push_back(rig.add(cube.graph, params_of({{0, 0, stiffness[i]}, {0, 0, 1}}), posed({2.0 * double(i), 0, 0})));
  const auto check_all = [&] {
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(pressed(rig, 2.0 * double(i)) == Approx(0.01 * stiffness[i]));
  };
  check_all();
  fdcg_error error;
  fdcg_object_id none;
  const std::vector<fdcg_material> one_more = {{0, 0, 7}};
  const fdcg_params another = params_of(one_more);
  const fdcg_pose away = posed({0, 20, 0});
  CHECK(fdcg_scene_add_object(rig.get(), &cube.graph, &another, &away, &none, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("config.material_capacity"));
  const std::vector<fdcg_material> longer(3, fdcg_material{0, 0, 50});
  const fdcg_params too_many = params_of(longer);
  CHECK(fdcg_scene_set_params(rig.get(), objects[1], &too_many, &error) == FDCG_E_ARGUMENT);
  check_all();

  const std::vector<fdcg_material> shorter = {{0, 0, 40}};
  const fdcg_params one_row = params_of(shorter);
  REQUIRE(fdcg_scene_set_params(rig.get(), objects[0], &one_row, &error) == FDCG_OK);
  stiffness[0] = 40;
  check_all();
  REQUIRE(fdcg_scene_set_params(rig.get(), objects[1], &too_many, &error) == FDCG_OK);
  stiffness[1] = 50;
  check_all();

  REQUIRE(fdcg_scene_remove_object(rig.get(), objects[1], &error) == FDCG_OK);
  const std::vector<fdcg_material> last = {{0, 0, 60}, {0, 0, 1}, {0, 0, 1}};
  rig.add(cube.graph, params_of(last), posed({2, 0, 0}));
  stiffness[1] = 60;
  check_all();
}

TEST_CASE("a copy of a scene has tables of its own") {
  const TwoMaterials cube;
  const fdcg_scene_config config = fdcg_make_scene_config();
  const std::uint64_t bytes = fdcg_scene_bytes(&config);
  std::vector<std::uint64_t> first(bytes / 8 + 1), second(bytes / 8 + 1);
  fdcg_scene* scene = nullptr;
  fdcg_error error;
  REQUIRE(fdcg_scene_create(first.data(), bytes, &config, &scene, &error) == FDCG_OK);
  const std::vector<fdcg_material> table = {{0, 0, 500}, {0, 0, 1}};
  const fdcg_params params = params_of(table);
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_object_id object;
  REQUIRE(fdcg_scene_add_object(scene, &cube.graph, &params, &pose, &object, &error) == FDCG_OK);
  double hip[3] = {0, 0, 0.6};
  fdcg_finger_id finger;
  REQUIRE(fdcg_scene_add_finger(scene, hip, &finger, &error) == FDCG_OK);
  fdcg_scene_step(scene);
  std::memcpy(second.data(), first.data(), bytes);
  std::memset(first.data(), 0xFF, bytes);
  scene = reinterpret_cast<fdcg_scene*>(second.data());
  hip[2] = 0.49;
  REQUIRE(fdcg_scene_move_finger(scene, finger, hip, &error) == FDCG_OK);
  SECTION("by a whole tick") {
    fdcg_scene_step(scene);
  }
  SECTION("by the second half of one") {
    REQUIRE(fdcg_scene_step_finger(scene, finger, &error) == FDCG_OK);
  }
  fdcg_finger_result result;
  REQUIRE(fdcg_scene_get_result(scene, finger, &result, &error) == FDCG_OK);
  CHECK(result.force_n[2] == Approx(5));
}
