// SPDX-License-Identifier: Apache-2.0
// Bodies that a scene's fingers push.
#include "body_math.hpp"
#include "message.hpp"

namespace fdcg {
namespace {

// The scene's torque is about the origin of the object's frame, the body's about its centre of mass.
void push(fdcg_body* body, const fdcg_reaction& reaction, double dt_s) {
  const fdcg_pose pose = fdcg_body_pose(body);
  const Vector force = vec(reaction.force_n);
  const Vector arm = vec(body->centre_m) - vec(pose.translation_m);
  double torque[3];
  put(vec(reaction.torque_n_m) - cross(arm, force), torque);
  fdcg_body_step(body, reaction.force_n, torque, dt_s);
}

fdcg_status check(const fdcg_scene* scene, const fdcg_scene_body* bodies, uint32_t body_count, uint32_t substeps,
                  const fdcg_reaction* reactions, uint32_t reaction_count, fdcg_error* error) {
  if (scene == nullptr || bodies == nullptr || reactions == nullptr)
    return Message(error, FDCG_E_ARGUMENT).text("scene, bodies or reactions: null pointer");
  if (substeps == 0 || substeps > FDCG_BODY_MAX_SUBSTEPS) {
    return Message(error, FDCG_E_ARGUMENT)
        .text("substeps is ")
        .number(substeps)
        .text(", allowed 1 to ")
        .number(FDCG_BODY_MAX_SUBSTEPS)
        .text("; a shorter tick, a softer contact or a heavier body needs fewer");
  }
  for (uint32_t i = 0; i < body_count; ++i) {
    if (bodies[i].object.index < reaction_count) continue;
    return Message(error, FDCG_E_ARGUMENT)
        .text("body ")
        .number(i)
        .text(": its object has index ")
        .number(bodies[i].object.index)
        .text(", there is room for the reactions of ")
        .number(reaction_count);
  }
  return FDCG_OK;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_scene_step_bodies(fdcg_scene* scene, fdcg_scene_body* bodies, uint32_t body_count,
                                              uint32_t substeps, double tick_s, fdcg_reaction* reactions,
                                              uint32_t reaction_count, fdcg_error* error) {
  fdcg_status status = fdcg::check(scene, bodies, body_count, substeps, reactions, reaction_count, error);
  for (uint32_t step = 0; status == FDCG_OK && step < substeps; ++step) {
    fdcg_scene_step(scene);
    fdcg_scene_reactions(scene, reactions, reaction_count);
    for (uint32_t i = 0; status == FDCG_OK && i < body_count; ++i) {
      const bool was_asleep = bodies[i].body.is_asleep != 0;
      fdcg::push(&bodies[i].body, reactions[bodies[i].object.index], tick_s / substeps);
      if (was_asleep && bodies[i].body.is_asleep != 0) continue;  // it has not moved
      const fdcg_pose pose = fdcg_body_pose(&bodies[i].body);
      status = fdcg_scene_set_pose(scene, bodies[i].object, &pose, error);
    }
  }
  return status;
}
