// SPDX-License-Identifier: Apache-2.0
// A mesh compiled anew takes an object's place while fingers touch it.
#include <cmath>
#include <vector>

#include "compiled.hpp"
#include "fdcg/surface.h"
#include "meshes.hpp"
#include "scene_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

struct Opened {
  bake::Compiled compiled;
  fdcg_graph graph{};
  explicit Opened(const bake::PolygonSoup& soup, const bake::CompileOptions& options = {})
      : compiled(compile_whole(soup, options)) {
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_SAFE, &graph, &error) == FDCG_OK);
  }
};

}  // namespace

TEST_CASE("a finger that touches goes on at the nearest place of the new graph, whatever its precision and scale") {
  const Opened sphere(ico_sphere(4));
  bake::CompileOptions single;
  single.precision = bake::Precision::f32;
  bake::CompileOptions other_units;
  other_units.metres_per_unit = 0.5;
  const Opened finer(ico_sphere(5)), in_floats(ico_sphere(5), single), scaled_down(scaled(ico_sphere(5), 2), other_units);
  for (const Opened* next : {&finer, &in_floats, &scaled_down}) {
    SceneRig rig(fdcg_make_scene_config());
    const fdcg_object_id object = rig.add(sphere.graph, fdcg_make_params(), posed({0, 0, 3}, {0, 0, 1}, 0.4, 0.5));
    const fdcg_finger_id finger = rig.add({0.05, 0.02, 3.6}), away = rig.add({0, 0, 5});
    rig.step();
    rig.move(finger, {0.05, 0.02, 3.49});
    rig.step();
    const fdcg_finger_result before = rig.result(finger);
    REQUIRE(before.touch_count == 1);
    const double force = before.force_n[2];
    fdcg_error error;
    REQUIRE(fdcg_scene_replace_graph(rig.get(), object, &next->graph, &error) == FDCG_OK);
    rig.step();
    const fdcg_finger_result after = rig.result(finger);
    REQUIRE(after.touch_count == 1);
    CHECK(after.touches[0].flags == 0);
    CHECK(after.force_n[2] == Approx(force).epsilon(0.1));
    rig.move(finger, {0.05, 0.02, 3.6});
    rig.step();
    CHECK(rig.result(finger).touch_count == 0);
    for (const double z : {3.6, 3.55, 3.49}) {
      rig.move(away, {0, 0, z});
      rig.step();
    }
    CHECK(rig.result(away).force_n[2] > 0);
  }
}

TEST_CASE("a finger that a smaller graph leaves in free air is free, and one beside a larger one is not caught inside") {
  const Opened large(cube()), small(scaled(cube(), 0.5));
  SceneRig rig(fdcg_make_scene_config());
  const fdcg_object_id object = rig.add(large.graph, fdcg_make_params(), posed({0, 0, 0}));
  const fdcg_finger_id finger = rig.add({0, 0, 0.6});
  rig.step();
  rig.move(finger, {0, 0, 0.45});
  rig.step();
  REQUIRE(rig.result(finger).force_n[2] > 0);
  fdcg_error error;
  REQUIRE(fdcg_scene_replace_graph(rig.get(), object, &small.graph, &error) == FDCG_OK);
  rig.step();
  CHECK(rig.result(finger).touch_count == 0);
  rig.move(finger, {0, 0, 0.2});
  rig.step();
  CHECK(rig.result(finger).force_n[2] == Approx(50));
  REQUIRE(fdcg_scene_replace_graph(rig.get(), object, &large.graph, &error) == FDCG_OK);
  rig.step();
  CHECK(rig.result(finger).touches[0].god_object_m[2] == Approx(0.5));
}

TEST_CASE("only a graph's object is given another graph") {
  const Opened box(cube());
  SceneRig rig(fdcg_make_scene_config());
  const fdcg_surface ball = fdcg_make_sphere(1);
  const fdcg_params params = fdcg_make_params();
  const fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_object_id object;
  fdcg_error error;
  REQUIRE(fdcg_scene_add_surface(rig.get(), &ball, &params, &pose, &object, &error) == FDCG_OK);
  CHECK(fdcg_scene_replace_graph(rig.get(), object, &box.graph, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("surface"));
  const fdcg_graph closed = {};
  const fdcg_object_id cube_id = rig.add(box.graph, params, pose);
  CHECK(fdcg_scene_replace_graph(rig.get(), cube_id, &closed, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_scene_replace_graph(rig.get(), {77, 3}, &box.graph, &error) == FDCG_E_ARGUMENT);
}
