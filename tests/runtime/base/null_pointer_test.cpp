// SPDX-License-Identifier: Apache-2.0
// The rule of fdcg.h for null pointers, over all of the runtime's headers: refused by name where there is a status; else
// nothing is done, or zeros come back.
#include <functional>
#include <string>
#include <vector>

#include "compiled.hpp"
#include "fdcg/deform.h"
#include "fdcg/pile.h"
#include "fdcg/scene_state.h"
#include "fdcg/soft_finger.h"
#include "fdcg/surface.h"
#include "meshes.hpp"
#include "pile_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

fdcg_scene_config roomy() {
  fdcg_scene_config config = fdcg_make_scene_config();
  config.has_soft_fingers = config.has_deforms = 1;
  return config;
}

// One of everything, so that of a call one argument alone is null.
struct World {
  PileRig rig{fdcg_make_pile_config(), roomy()};
  bake::Compiled triangles;
  fdcg_graph graph{};
  std::vector<std::uint64_t> memory;
  fdcg_deform* deform = nullptr;
  fdcg_error error{};
  fdcg_params params = fdcg_make_params();
  fdcg_pose pose = fdcg_make_identity_pose();
  double place[3] = {0, 0, 1};
  fdcg_finger_id finger = rig.scene().add({0, 0, 1});
  fdcg_object_id object = rig.add_fixed(rig.box(1, 1, 1), params, pose);
  fdcg_surface ball = fdcg_make_sphere(1);
  fdcg_mass mass{};
  fdcg_body_config body_config = fdcg_make_body_config();
  fdcg_scene_body body{};
  fdcg_reaction reactions[2]{};
  fdcg_deform_config deform_config = fdcg_make_deform_config();
  fdcg_pile_config pile_config = fdcg_make_pile_config();
  fdcg_scene_config scene_config = fdcg_make_scene_config();
  std::uint32_t corner = 0;

  World() {
    bake::CompileOptions options;
    options.triangles = true;
    triangles = compile_whole(cube(), options);
    REQUIRE(fdcg_open_memory(triangles.bytes.data(), triangles.bytes.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
    memory.resize(fdcg_deform_bytes(&graph) / 8 + 8);
    REQUIRE(fdcg_deform_create(memory.data(), memory.size() * 8, &graph, &deform_config, &deform, &error) == FDCG_OK);
    REQUIRE(fdcg_surface_get_mass(&ball, &mass, &error) == FDCG_OK);
    body.object = object;
    REQUIRE(fdcg_body_init(&body.body, &body_config, &pose, &error) == FDCG_OK);
  }
  fdcg_scene* scene() { return rig.scene().get(); }
};

struct Call {
  const char* null_one;  // named in the message
  std::function<fdcg_status(World&, fdcg_error*)> make;
};

const std::vector<Call> kObjectsAndFingers = {
    {"config",
     [](World& w, fdcg_error* e) {
       fdcg_scene* s;
       return fdcg_scene_create(w.memory.data(), 8, nullptr, &s, e);
     }},
    {"memory",
     [](World& w, fdcg_error* e) {
       fdcg_scene* s;
       return fdcg_scene_create(nullptr, 8, &w.scene_config, &s, e);
     }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_create(w.memory.data(), 8, &w.scene_config, nullptr, e); }},
    {"scene",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_object(nullptr, &w.graph, &w.params, &w.pose, &w.object, e); }},
    {"graph",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_object(w.scene(), nullptr, &w.params, &w.pose, &w.object, e); }},
    {"params",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_object(w.scene(), &w.graph, nullptr, &w.pose, &w.object, e); }},
    {"pose",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_object(w.scene(), &w.graph, &w.params, nullptr, &w.object, e); }},
    {"object",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_object(w.scene(), &w.graph, &w.params, &w.pose, nullptr, e); }},
    {"scene",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_surface(nullptr, &w.ball, &w.params, &w.pose, &w.object, e); }},
    {"surface",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_surface(w.scene(), nullptr, &w.params, &w.pose, &w.object, e); }},
    {"scene",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_deform(nullptr, w.deform, &w.params, &w.pose, &w.object, e); }},
    {"deform",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_deform(w.scene(), nullptr, &w.params, &w.pose, &w.object, e); }},
    {"params",
     [](World& w, fdcg_error* e) { return fdcg_scene_add_deform(w.scene(), w.deform, nullptr, &w.pose, &w.object, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_remove_object(nullptr, w.object, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_set_pose(nullptr, w.object, &w.pose, e); }},
    {"pose", [](World& w, fdcg_error* e) { return fdcg_scene_set_pose(w.scene(), w.object, nullptr, e); }},
    {"params", [](World& w, fdcg_error* e) { return fdcg_scene_set_params(w.scene(), w.object, nullptr, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_set_params(nullptr, w.object, &w.params, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_enable_object(nullptr, w.object, 1, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_add_finger(nullptr, w.place, &w.finger, e); }},
    {"hip_world_m", [](World& w, fdcg_error* e) { return fdcg_scene_add_finger(w.scene(), nullptr, &w.finger, e); }},
    {"finger", [](World& w, fdcg_error* e) { return fdcg_scene_add_finger(w.scene(), w.place, nullptr, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_remove_finger(nullptr, w.finger, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_move_finger(nullptr, w.finger, w.place, e); }},
    {"hip_world_m", [](World& w, fdcg_error* e) { return fdcg_scene_move_finger(w.scene(), w.finger, nullptr, e); }},
    {"hip_world_m", [](World& w, fdcg_error* e) { return fdcg_scene_reset_finger(w.scene(), w.finger, nullptr, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_set_finger_material(nullptr, w.finger, nullptr, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_step_finger(nullptr, w.finger, e); }},
    {"scene",
     [](World& w, fdcg_error* e) {
       fdcg_finger_result r;
       return fdcg_scene_get_result(nullptr, w.finger, &r, e);
     }},
    {"result", [](World& w, fdcg_error* e) { return fdcg_scene_get_result(w.scene(), w.finger, nullptr, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_save(nullptr, w.place, 8, e); }},
    {"state", [](World& w, fdcg_error* e) { return fdcg_scene_save(w.scene(), nullptr, 8, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_restore(nullptr, w.place, 8, e); }},
    {"state", [](World& w, fdcg_error* e) { return fdcg_scene_restore(w.scene(), nullptr, 8, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_set_finger_radius(nullptr, w.finger, 0, e); }},
    {"scene",
     [](World& w, fdcg_error* e) { return fdcg_scene_set_finger_rotation(nullptr, w.finger, w.pose.rotation_xyzw, e); }},
    {"rotation_xyzw", [](World& w, fdcg_error* e) { return fdcg_scene_set_finger_rotation(w.scene(), w.finger, nullptr, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_get_finger_torque(nullptr, w.finger, w.place, e); }},
    {"torque_n_m", [](World& w, fdcg_error* e) { return fdcg_scene_get_finger_torque(w.scene(), w.finger, nullptr, e); }},
};

const std::vector<Call> kShapesAndBodies = {
    {"params", [](World&, fdcg_error* e) { return fdcg_check_params(nullptr, e); }},
    {"surface", [](World&, fdcg_error* e) { return fdcg_check_surface(nullptr, e); }},
    {"surface", [](World& w, fdcg_error* e) { return fdcg_surface_get_mass(nullptr, &w.mass, e); }},
    {"mass", [](World& w, fdcg_error* e) { return fdcg_surface_get_mass(&w.ball, nullptr, e); }},
    {"graph", [](World& w, fdcg_error* e) { return fdcg_get_mass(nullptr, &w.mass, e); }},
    {"mass", [](World& w, fdcg_error* e) { return fdcg_get_mass(&w.graph, nullptr, e); }},
    {"config", [](World& w, fdcg_error* e) { return fdcg_body_set_mass(nullptr, &w.mass, 1, 1, e); }},
    {"mass", [](World& w, fdcg_error* e) { return fdcg_body_set_mass(&w.body_config, nullptr, 1, 1, e); }},
    {"body", [](World& w, fdcg_error* e) { return fdcg_body_init(nullptr, &w.body_config, &w.pose, e); }},
    {"config", [](World& w, fdcg_error* e) { return fdcg_body_init(&w.body.body, nullptr, &w.pose, e); }},
    {"pose", [](World& w, fdcg_error* e) { return fdcg_body_init(&w.body.body, &w.body_config, nullptr, e); }},
    {"body", [](World& w, fdcg_error* e) { return fdcg_body_set_motion(nullptr, w.place, w.place, e); }},
    {"velocity", [](World& w, fdcg_error* e) { return fdcg_body_set_motion(&w.body.body, nullptr, w.place, e); }},
    {"angular velocity", [](World& w, fdcg_error* e) { return fdcg_body_set_motion(&w.body.body, w.place, nullptr, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_scene_step_bodies(nullptr, &w.body, 1, 1, 1e-3, w.reactions, 2, e); }},
    {"bodies",
     [](World& w, fdcg_error* e) { return fdcg_scene_step_bodies(w.scene(), nullptr, 1, 1, 1e-3, w.reactions, 2, e); }},
    {"reactions",
     [](World& w, fdcg_error* e) { return fdcg_scene_step_bodies(w.scene(), &w.body, 1, 1, 1e-3, nullptr, 2, e); }},
};

const std::vector<Call> kPilesAndSheets = {
    {"pile", [](World& w, fdcg_error* e) { return fdcg_pile_create(w.memory.data(), 8, &w.pile_config, nullptr, e); }},
    {"config",
     [](World& w, fdcg_error* e) {
       fdcg_pile* p;
       return fdcg_pile_create(w.memory.data(), 8, nullptr, &p, e);
     }},
    {"memory",
     [](World& w, fdcg_error* e) {
       fdcg_pile* p;
       return fdcg_pile_create(nullptr, 8, &w.pile_config, &p, e);
     }},
    {"pile", [](World& w, fdcg_error* e) { return fdcg_pile_set_ground(nullptr, w.place, 0, &w.params, e); }},
    {"normal", [](World& w, fdcg_error* e) { return fdcg_pile_set_ground(w.rig.pile(), nullptr, 0, &w.params, e); }},
    {"pile", [](World& w, fdcg_error* e) { return fdcg_pile_add(nullptr, w.scene(), w.object, nullptr, 0, e); }},
    {"scene", [](World& w, fdcg_error* e) { return fdcg_pile_add(w.rig.pile(), nullptr, w.object, nullptr, 0, e); }},
    {"points_m", [](World& w, fdcg_error* e) { return fdcg_pile_add(w.rig.pile(), w.scene(), w.object, nullptr, 1, e); }},
    {"pile", [](World& w, fdcg_error* e) { return fdcg_pile_remove(nullptr, w.object, e); }},
    {"graph", [](World& w, fdcg_error* e) { return fdcg_pick_points(nullptr, &w.place, 1, &w.corner, e); }},
    {"points_m", [](World& w, fdcg_error* e) { return fdcg_pick_points(&w.graph, nullptr, 1, &w.corner, e); }},
    {"count", [](World& w, fdcg_error* e) { return fdcg_pick_points(&w.graph, &w.place, 1, nullptr, e); }},
    {"pile",
     [](World& w, fdcg_error* e) { return fdcg_scene_step_pile(w.scene(), nullptr, &w.body, 1, 1, 1e-3, w.reactions, 2, e); }},
    {"scene",
     [](World& w, fdcg_error* e) {
       return fdcg_scene_step_pile(nullptr, w.rig.pile(), &w.body, 1, 1, 1e-3, w.reactions, 2, e);
     }},
    {"bodies",
     [](World& w, fdcg_error* e) {
       return fdcg_scene_step_pile(w.scene(), w.rig.pile(), nullptr, 1, 1, 1e-3, w.reactions, 2, e);
     }},
    {"deform",
     [](World& w, fdcg_error* e) { return fdcg_deform_create(w.memory.data(), 8, &w.graph, &w.deform_config, nullptr, e); }},
    {"config",
     [](World& w, fdcg_error* e) {
       fdcg_deform* d;
       return fdcg_deform_create(w.memory.data(), 8, &w.graph, nullptr, &d, e);
     }},
    {"graph",
     [](World& w, fdcg_error* e) {
       fdcg_deform* d;
       return fdcg_deform_create(w.memory.data(), 8, nullptr, &w.deform_config, &d, e);
     }},
    {"memory",
     [](World& w, fdcg_error* e) {
       fdcg_deform* d;
       return fdcg_deform_create(nullptr, 8, &w.graph, &w.deform_config, &d, e);
     }},
    {"deform", [](World& w, fdcg_error* e) { return fdcg_deform_find(nullptr, w.place, &w.corner, e); }},
    {"position", [](World& w, fdcg_error* e) { return fdcg_deform_find(w.deform, nullptr, &w.corner, e); }},
    {"corner", [](World& w, fdcg_error* e) { return fdcg_deform_find(w.deform, w.place, nullptr, e); }},
    {"deform", [](World& w, fdcg_error* e) { return fdcg_deform_move(nullptr, 0, w.place, e); }},
    {"position", [](World& w, fdcg_error* e) { return fdcg_deform_move(w.deform, 0, nullptr, e); }},
    {"deform", [](World& w, fdcg_error* e) { return fdcg_deform_move_corners(nullptr, &w.corner, w.place, 1, e); }},
    {"corners", [](World& w, fdcg_error* e) { return fdcg_deform_move_corners(w.deform, nullptr, w.place, 1, e); }},
    {"positions", [](World& w, fdcg_error* e) { return fdcg_deform_move_corners(w.deform, &w.corner, nullptr, 1, e); }},
    {"deform", [](World& w, fdcg_error* e) { return fdcg_deform_place(nullptr, 0, w.place, e); }},
    {"position", [](World& w, fdcg_error* e) { return fdcg_deform_place(w.deform, 0, nullptr, e); }},
};

}  // namespace

TEST_CASE("null pointers: refused by name in every call with a status, with and without an error struct") {
  World world;
  for (const std::vector<Call>* calls : {&kObjectsAndFingers, &kShapesAndBodies, &kPilesAndSheets}) {
    for (std::size_t i = 0; i < calls->size(); ++i) {
      const Call& call = (*calls)[i];
      CAPTURE(i, call.null_one);
      fdcg_error error = {};
      CHECK(call.make(world, &error) == FDCG_E_ARGUMENT);
      CHECK(error.status == FDCG_E_ARGUMENT);
      CHECK_THAT(error.message, ContainsSubstring(call.null_one) && ContainsSubstring("null pointer"));
      CHECK(call.make(world, nullptr) == FDCG_E_ARGUMENT);
    }
  }
}

TEST_CASE("null pointers: calls without a status do nothing or return zeros") {
  World world;
  const fdcg_body before = world.body.body;
  fdcg_body_step(nullptr, world.place, world.place, 1e-3);
  fdcg_body_step(&world.body.body, nullptr, world.place, 1e-3);
  fdcg_body_step(&world.body.body, world.place, nullptr, 1e-3);
  CHECK(world.body.body.refused_steps == 2);
  CHECK(world.body.body.centre_m[2] == before.centre_m[2]);
  CHECK(fdcg_body_get_pose(nullptr).scale == 0);
  CHECK(fdcg_body_get_kinetic_energy_j(nullptr) == 0);
  CHECK(fdcg_body_get_substeps(nullptr, 1, 1, 1) == 0);
  double spin[3] = {1, 1, 1};
  fdcg_body_get_angular_velocity(&world.body.body, nullptr);
  fdcg_body_get_angular_velocity(nullptr, spin);
  CHECK(spin[0] == 0);
  CHECK(fdcg_pile_bytes(nullptr) == 0);
  CHECK(fdcg_pile_get_touches(nullptr, nullptr, 3) == 0);
  CHECK(fdcg_pile_get_touches(world.rig.pile(), nullptr, 3) == 0);
  CHECK(fdcg_pile_get_counts(nullptr).broadphase_updates == 0);
  CHECK(fdcg_scene_bytes(nullptr) == 0);
  fdcg_scene_step(nullptr);
  fdcg_scene_advance(nullptr);
  fdcg_reaction reaction = {{1, 1, 1}, {1, 1, 1}};
  fdcg_scene_get_reactions(world.scene(), nullptr, 1);
  fdcg_scene_get_reactions(nullptr, &reaction, 1);
  CHECK(reaction.force_n[0] == 0);
  CHECK(fdcg_deform_bytes(nullptr) == 0);
  CHECK(fdcg_deform_get_graph(nullptr) == nullptr);
  fdcg_params_init(nullptr, 8);
  fdcg_scene_config_init(nullptr, 8);
  fdcg_pile_config_init(nullptr, 8);
  fdcg_body_config_init(nullptr, 8);
  fdcg_deform_config_init(nullptr, 8);
  fdcg_surface_init(nullptr, 8);
  fdcg_close(nullptr);
}
