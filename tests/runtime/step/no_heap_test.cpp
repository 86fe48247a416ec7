// SPDX-License-Identifier: Apache-2.0
// The runtime does not use the heap: neither opening nor stepping nor building up and taking down a scene.
#include <cstdio>
#include <string>
#include <vector>

#include "../../bench/heap_count.hpp"
#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/pile.h"
#include "meshes.hpp"
#include "random.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::test;
namespace bake = fdcg::bake;

namespace {

AlignedBytes compiled(const bake::PolygonSoup& soup, bake::Precision precision) {
  bake::CompileOptions options;
  options.precision = precision;
  const auto result = bake::compile(soup, options);
  REQUIRE(result);
  return AlignedBytes(result->bytes);
}

// Calls of the heap while `work` runs. The test's own checks wait until it is over.
template <class Work>
std::uint64_t heap_calls_of(const Work& work) {
  const std::uint64_t before = heap_calls();
  work();
  return heap_calls() - before;
}

}  // namespace

TEST_CASE("the counter counts") {
  if (!can_count_heap_calls()) return;
  CHECK(heap_calls_of([] { delete new std::string(100, 'x'); }) >= 2);
}

TEST_CASE("opening, refusing, stepping and closing call no heap") {
  const std::string path = "no_heap_test.fdcg";
  for (const auto precision : {bake::Precision::f64, bake::Precision::f32}) {
    AlignedBytes file = compiled(cone(400), precision);
    std::FILE* out = std::fopen(path.c_str(), "wb");
    REQUIRE(out != nullptr);
    REQUIRE(std::fwrite(file.data(), 1, file.size(), out) == file.size());
    std::fclose(out);
    int opened = 0;
    CHECK(heap_calls_of([&] {
            fdcg_graph graph;
            fdcg_error error;
            opened += fdcg_open_memory(file.data(), file.size() - 8, FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_TRUNCATED;
            opened += fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_TRUSTED, &graph, &error) == FDCG_OK;
            touch_everywhere(graph, 3000);
            fdcg_close(&graph);
            opened += fdcg_open_file(path.c_str(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK;
            touch_everywhere(graph, 3000);
            fdcg_close(&graph);
            opened += fdcg_open_file("/no/such/file", FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_E_IO;
          }) == 0);
    CHECK(opened == 4);
  }
  std::remove(path.c_str());
}

TEST_CASE("a scene is created in its caller's memory, filled, moved, stepped and emptied without the heap") {
  AlignedBytes file = compiled(star_sphere(2, 0.3, 5), bake::Precision::f64);
  fdcg_graph graph;
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK);
  fdcg_scene_config config = fdcg_make_scene_config();
  std::vector<double> memory(fdcg_scene_bytes(&config) / sizeof(double) + 1);
  Random random(11);
  int refused = 0, touched = 0;
  CHECK(heap_calls_of([&] {
          fdcg_scene* scene = nullptr;
          fdcg_error error;
          refused += fdcg_scene_create(memory.data(), memory.size() * sizeof(double), &config, &scene, &error) != FDCG_OK;
          const fdcg_params params = fdcg_make_params();
          fdcg_object_id objects[8];
          fdcg_finger_id fingers[4];
          fdcg_pose pose = fdcg_make_identity_pose();
          for (int i = 0; i < 8; ++i) {
            pose.translation_m[0] = 2.0 * i;
            refused += fdcg_scene_add_object(scene, &graph, &params, &pose, &objects[i], &error) != FDCG_OK;
          }
          for (int i = 0; i < 4; ++i) {
            const double hip[3] = {3.0 * i, 0, 2};
            refused += fdcg_scene_add_finger(scene, hip, &fingers[i], &error) != FDCG_OK;
          }
          for (int tick = 0; tick < 2000; ++tick) {
            pose.translation_m[0] = 2.0 * (tick % 8) + 1e-3 * tick;
            refused += fdcg_scene_set_pose(scene, objects[tick % 8], &pose, &error) != FDCG_OK;
            for (const fdcg_finger_id finger : fingers) {
              const double hip[3] = {random.uniform(-1, 16), random.uniform(-0.7, 0.7), random.uniform(-0.7, 1.2)};
              refused += fdcg_scene_move_finger(scene, finger, hip, &error) != FDCG_OK;
            }
            fdcg_scene_step(scene);
            fdcg_finger_result result;
            refused += fdcg_scene_get_result(scene, fingers[tick % 4], &result, &error) != FDCG_OK;
            touched += result.touch_count > 0;
          }
          refused += fdcg_scene_remove_finger(scene, fingers[0], &error) != FDCG_OK;
          refused += fdcg_scene_remove_object(scene, objects[0], &error) != FDCG_OK;
        }) == 0);
  CHECK(refused == 0);
  CHECK(touched > 100);
}

TEST_CASE("a pile is created in its caller's memory, filled, stepped and emptied without the heap") {
  AlignedBytes file = compiled(cube(), bake::Precision::f64);
  fdcg_graph graph;
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK);
  const fdcg_scene_config scene_config = fdcg_make_scene_config();
  const fdcg_pile_config config = fdcg_make_pile_config();
  std::vector<double> scene_memory(fdcg_scene_bytes(&scene_config) / sizeof(double) + 1);
  std::vector<double> memory(fdcg_pile_bytes(&config) / sizeof(double) + 1);
  int refused = 0;
  std::uint32_t touched = 0;
  CHECK(heap_calls_of([&] {
          fdcg_scene* scene = nullptr;
          fdcg_pile* pile = nullptr;
          fdcg_error error;
          refused += fdcg_scene_create(scene_memory.data(), scene_memory.size() * sizeof(double), &scene_config, &scene,
                                       &error) != FDCG_OK;
          refused += fdcg_pile_create(memory.data(), memory.size() * sizeof(double), &config, &pile, &error) != FDCG_OK;
          const fdcg_params params = fdcg_make_params();
          const double up[3] = {0, 0, 1};
          refused += fdcg_pile_set_ground(pile, up, 0, &params, &error) != FDCG_OK;
          double points[20][3];
          std::uint32_t count = 0;
          refused += fdcg_pick_points(&graph, points, 20, &count, &error) != FDCG_OK;
          fdcg_scene_body bodies[4] = {};
          fdcg_body_config body = fdcg_make_body_config();
          for (double& moment : body.inertia_kg_m2)
            moment = &moment < body.inertia_kg_m2 + 3 ? 1.0 / 6 : 0;
          fdcg_pose pose = fdcg_make_identity_pose();
          for (int i = 0; i < 4; ++i) {
            pose.translation_m[0] = 0.2 * i;
            pose.translation_m[2] = 0.6 + 1.1 * i;
            refused += fdcg_scene_add_object(scene, &graph, &params, &pose, &bodies[i].object, &error) != FDCG_OK;
            refused += fdcg_body_init(&bodies[i].body, &body, &pose, &error) != FDCG_OK;
            refused += fdcg_pile_add(pile, scene, bodies[i].object, points, count, &error) != FDCG_OK;
          }
          fdcg_reaction reactions[4];
          for (int tick = 0; tick < 1000; ++tick) {
            refused += fdcg_scene_step_pile(scene, pile, bodies, 4, 1, 1e-3, reactions, 4, &error) != FDCG_OK;
            touched += fdcg_pile_get_touches(pile, nullptr, 0);
          }
          refused += fdcg_pile_remove(pile, bodies[0].object, &error) != FDCG_OK;
        }) == 0);
  CHECK(refused == 0);
  CHECK(touched > 1000);
}
