// SPDX-License-Identifier: Apache-2.0
// What contradicts itself is refused by name, and what only looks so works: contacts on other graphs, parameters of zeros,
// copies of graphs that are closed, views and tables that go away, ids of other scenes, bodies that are moved twice.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "compiled.hpp"
#include "fdcg/body.h"
#include "fdcg/deform.h"
#include "fdcg/fdcg.hpp"
#include "fdcg/surface.h"
#include "meshes.hpp"
#include "scene_rig.hpp"
#include "scratch_folder.hpp"

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

fdcg_result step(const fdcg_graph& graph, const fdcg_params& params, fdcg_contact& contact, double x, double y, double z) {
  const double hip[3] = {x, y, z};
  fdcg_result result;
  fdcg_step(&graph, &params, &contact, hip, &result);
  return result;
}

bool is_same(const fdcg_contact& a, const fdcg_contact& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void check_refused(const fdcg_result& result, std::uint32_t flag) {
  CHECK(result.flags == flag);
  CHECK((result.flags & FDCG_RESULT_REFUSED) != 0);
  CHECK(result.state == FDCG_FREE);
  CHECK(result.feature == FDCG_NONE);
  for (const double f : result.force_n)
    CHECK(f == 0);
}

class File {
 public:
  explicit File(const std::vector<std::byte>& bytes) : path_(scratch_folder() / "graph.fdcg") {
    std::ofstream(path_, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace

TEST_CASE("a contact is refused on another graph, and goes on on its own") {
  const Opened sphere(ico_sphere(3)), box(cube()), finer(ico_sphere(4));
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {};
  for (int i = 0; i < 20; ++i)
    step(sphere.graph, params, contact, 1.1 - 0.02 * i, 0.1, 0.1);
  REQUIRE(contact.state == FDCG_FACE);
  const fdcg_contact before = contact;
  for (const fdcg_graph* other : {&box.graph, &finer.graph}) {
    check_refused(step(*other, params, contact, 0.05, 0.05, 0.05), FDCG_RESULT_OTHER_CONTACT);
    CHECK(is_same(contact, before));
  }
  const fdcg_result result = step(sphere.graph, params, contact, 0.72, 0.1, 0.1);
  CHECK(result.flags == 0);
  CHECK(result.force_n[0] > 0);
}

TEST_CASE("the same file opened again is the same graph to a contact") {
  const Opened first(cube()), again(cube());
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {};
  step(first.graph, params, contact, 0.1, 0.1, 0.6);
  step(first.graph, params, contact, 0.1, 0.1, 0.49);
  CHECK(step(again.graph, params, contact, 0.1, 0.1, 0.48).force_n[2] > 0);
}

TEST_CASE("a contact is refused on another kind of thing") {
  bake::CompileOptions options;
  options.triangles = true;
  const Opened box(cube(), options);
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {};
  step(box.graph, params, contact, 0.1, 0.2, 0.6);
  step(box.graph, params, contact, 0.1, 0.2, 0.49);
  const fdcg_contact before = contact;
  fdcg_result result;
  const double hip[3] = {0.1, 0.2, 0.49};
  const fdcg_surface surface = fdcg_make_box(0.5, 0.5, 0.5), ball = fdcg_make_sphere(0.5);
  fdcg_surface_step(&surface, &params, &contact, hip, &result);
  check_refused(result, FDCG_RESULT_OTHER_CONTACT);
  CHECK(is_same(contact, before));

  fdcg_contact on_surface = {};
  fdcg_surface_step(&surface, &params, &on_surface, hip, &result);
  check_refused(step(box.graph, params, on_surface, 0.1, 0.2, 0.49), FDCG_RESULT_OTHER_CONTACT);
  fdcg_surface_step(&ball, &params, &on_surface, hip, &result);
  check_refused(result, FDCG_RESULT_OTHER_CONTACT);

  std::vector<std::uint64_t> memory(fdcg_deform_bytes(&box.graph) / 8 + 8);
  const fdcg_deform_config config = fdcg_make_deform_config();
  fdcg_deform* deform = nullptr;
  fdcg_error error;
  REQUIRE(fdcg_deform_create(memory.data(), memory.size() * 8, &box.graph, &config, &deform, &error) == FDCG_OK);
  fdcg_deform_contact on_deform = {};
  on_deform.contact = before;
  fdcg_deform_step(deform, &params, &on_deform, hip, &result);
  check_refused(result, FDCG_RESULT_OTHER_CONTACT);
  on_deform = {};
  fdcg_deform_step(deform, &params, &on_deform, hip, &result);
  CHECK(result.flags == 0);
  check_refused(step(box.graph, params, on_deform.contact, 0.1, 0.2, 0.49), FDCG_RESULT_OTHER_CONTACT);
}

TEST_CASE("a step by parameters of zeros, of a size that cannot be, or of no numbers is refused") {
  const Opened box(cube());
  const fdcg_surface ball = fdcg_make_sphere(0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<fdcg_params> bad(6, fdcg_make_params());
  bad[0] = {};
  bad[0].stiffness_n_per_m = 500;  // made by hand, without its size
  bad[1].struct_bytes += 8;        // of a newer header
  bad[2].stiffness_n_per_m = nan;
  bad[3].damping_n_s_per_m = -5;
  bad[4].mu_static = HUGE_VAL;
  bad[5].mu_dynamic = nan;
  for (const fdcg_params& params : bad) {
    CHECK(fdcg_check_params(&params, nullptr) == FDCG_E_ARGUMENT);
    fdcg_contact contact = {};
    for (const double z : {0.6, 0.49, 0.48})
      check_refused(step(box.graph, params, contact, 0.1, 0.1, z), FDCG_RESULT_BAD_PARAMS);
    CHECK(is_same(contact, fdcg_contact{}));
    fdcg_result result;
    const double hip[3] = {0, 0, 0.4};
    fdcg_surface_step(&ball, &params, &contact, hip, &result);
    check_refused(result, FDCG_RESULT_BAD_PARAMS);
    CHECK(step(box.graph, fdcg_make_params(), contact, 0.1, 0.1, 0.6).flags == 0);
  }
}

TEST_CASE("a step on a graph that is not open is refused") {
  const fdcg_graph closed = {};
  fdcg_contact contact = {};
  check_refused(step(closed, fdcg_make_params(), contact, 0, 0, 0), FDCG_RESULT_NOT_OPEN);
}

TEST_CASE("a copy of a graph is closed without taking the file from the struct that was opened") {
  const File file(compile_whole(cube()).bytes);
  fdcg_graph graph, moved = {};
  fdcg_error error;
  REQUIRE(fdcg_open_file(file.path().c_str(), FDCG_VERIFY_SAFE, &graph, &error) == FDCG_OK);
  fdcg_graph copy = graph;
  std::string said;
  fdcg_set_log_handler([](void* to, fdcg_log_level, const char* text) { *static_cast<std::string*>(to) = text; }, &said);
  CHECK(fdcg_close(&copy) == FDCG_E_ARGUMENT);
  fdcg_set_log_handler(nullptr, nullptr);
  CHECK_THAT(said, ContainsSubstring("a copy was closed"));
  CHECK(copy.header == nullptr);
  fdcg_contact contact = {};
  step(graph, fdcg_make_params(), contact, 0.1, 0.1, 0.6);
  CHECK(step(graph, fdcg_make_params(), contact, 0.1, 0.1, 0.49).force_n[2] > 0);

  copy = graph;
  CHECK(fdcg_move_graph(&copy, &moved, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("a copy"));
  REQUIRE(fdcg_move_graph(&graph, &moved, &error) == FDCG_OK);
  CHECK(graph.header == nullptr);
  CHECK(fdcg_close(&graph) == FDCG_OK);
  CHECK(step(moved, fdcg_make_params(), contact, 0.1, 0.1, 0.48).force_n[2] > 0);
  CHECK(fdcg_close(&moved) == FDCG_OK);
}

TEST_CASE("graphs of C++ move in a vector that grows, and a scene keeps feeling them") {
  const File file(compile_whole(cube()).bytes);
  SceneRig rig(fdcg_make_scene_config());
  std::vector<Graph> graphs;
  fdcg_error error;
  for (int i = 0; i < 20; ++i) {
    graphs.emplace_back();
    REQUIRE(graphs.back().open_file(file.path().c_str(), &error));
    rig.add(graphs.back().c_graph(), fdcg_make_params(), posed({2.0 * i, 0, 0}));
  }
  for (int i = 0; i < 20; ++i) {
    const fdcg_finger_id finger = rig.add({2.0 * i + 0.1, 0.1, 0.6});
    rig.step();
    rig.move(finger, {2.0 * i + 0.1, 0.1, 0.49});
    rig.step();
    CHECK(rig.result(finger).force_n[2] > 0);
    REQUIRE(fdcg_scene_remove_finger(rig.get(), finger, &error) == FDCG_OK);
  }
}

TEST_CASE("an id of another scene names nothing") {
  const Opened box(cube());
  SceneRig one(fdcg_make_scene_config()), other(fdcg_make_scene_config());
  const fdcg_pose pose = fdcg_make_identity_pose();
  one.add(box.graph, fdcg_make_params(), pose);
  const fdcg_object_id object = other.add(box.graph, fdcg_make_params(), pose);
  one.add(Place{0, 0, 1});
  const fdcg_finger_id finger = other.add(Place{0, 0, 1});
  fdcg_error error;
  CHECK(fdcg_scene_set_pose(one.get(), object, &pose, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("object: not in this scene"));
  CHECK(fdcg_scene_remove_finger(one.get(), finger, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("finger: not in this scene"));
  CHECK(fdcg_scene_set_pose(other.get(), object, &pose, &error) == FDCG_OK);
  CHECK(fdcg_scene_remove_finger(other.get(), finger, &error) == FDCG_OK);
  CHECK(fdcg_scene_remove_finger(other.get(), finger, &error) == FDCG_E_ARGUMENT);
}

namespace {

// A body of the scene, at a pose, made at another.
struct Fallen {
  Opened box{cube()};
  SceneRig rig{fdcg_make_scene_config()};
  fdcg_scene_body body{};
  fdcg_reaction reactions[1];
  fdcg_error error{};

  Fallen(const fdcg_pose& object_pose, const fdcg_pose& body_pose) {
    body.object = rig.add(box.graph, fdcg_make_params(), object_pose);
    const fdcg_body_config config = fdcg_make_body_config();
    REQUIRE(fdcg_body_init(&body.body, &config, &body_pose, &error) == FDCG_OK);
  }
  fdcg_status tick() { return fdcg_scene_step_bodies(rig.get(), &body, 1, 1, 0.001, reactions, 1, &error); }
};

}  // namespace

TEST_CASE("a body whose object is elsewhere is refused") {
  Fallen fallen(posed({1, 2, 3}, {0, 0, 1}, 0.3), posed({1, 2, 4}, {0, 0, 1}, 0.3));
  CHECK(fallen.tick() == FDCG_E_ARGUMENT);
  CHECK_THAT(fallen.error.message, ContainsSubstring("body 0") && ContainsSubstring("fdcg_body_set_push"));
}

TEST_CASE("a body whose object's pose is set between ticks is refused, unless the body is made there too") {
  Fallen fallen(posed({1, 2, 3}, {0, 0, 1}, 0.3), posed({1, 2, 3}, {0, 0, 1}, 0.3));
  for (int i = 0; i < 1000; ++i)
    REQUIRE(fallen.tick() == FDCG_OK);
  const fdcg_pose there = posed({5, 2, 3}, {0, 1, 0}, 0.7);
  REQUIRE(fdcg_scene_set_pose(fallen.rig.get(), fallen.body.object, &there, &fallen.error) == FDCG_OK);
  CHECK(fallen.tick() == FDCG_E_ARGUMENT);
  const fdcg_body_config config = fdcg_make_body_config();
  REQUIRE(fdcg_body_init(&fallen.body.body, &config, &there, &fallen.error) == FDCG_OK);
  CHECK(fallen.tick() == FDCG_OK);
}

TEST_CASE("a body that is stepped beside its scene is refused: its time would run twice") {
  Fallen fallen(posed({1, 2, 3}), posed({1, 2, 3}));
  REQUIRE(fallen.tick() == FDCG_OK);
  const double force[3] = {0, 0, 1}, torque[3] = {0, 0, 0};
  fdcg_body_step(&fallen.body.body, force, torque, 0.001);
  CHECK(fallen.tick() == FDCG_E_ARGUMENT);
  CHECK_THAT(fallen.error.message, ContainsSubstring("fdcg_body_set_push"));
}
