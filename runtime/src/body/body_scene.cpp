// SPDX-License-Identifier: Apache-2.0
// Bodies that a scene's fingers push.
#include "body/body_scene.hpp"
#include "base/message.hpp"
#include "scene/scene_memory.hpp"

namespace fdcg {
namespace {

// Checks that each body is initialised, has its own object, and has room for its reactions. The first body at each index is
// recorded in the reactions, which are zeroed before use, and here if a body is refused.
fdcg_status check_objects(const fdcg_scene_body* bodies, uint32_t body_count, fdcg_reaction* reactions, uint32_t reaction_count,
                          fdcg_error* error) {
  for (uint32_t i = 0; i < body_count; ++i) {
    if (bodies[i].object.index < reaction_count) continue;
    return Message(error, FDCG_E_ARGUMENT)
        .say("body ", i, ": its object has index ", bodies[i].object.index, ", there is room for the reactions of ",
             reaction_count);
  }
  for (uint32_t i = body_count; i-- > 0;)
    reactions[bodies[i].object.index].force_n[0] = i;
  uint32_t bad = 0, first = 0;
  for (; bad < body_count; ++bad) {
    first = static_cast<uint32_t>(reactions[bodies[bad].object.index].force_n[0]);
    if (first != bad || !(bodies[bad].body.config.mass_kg > 0)) break;
  }
  if (bad == body_count) return FDCG_OK;
  for (uint32_t i = 0; i < reaction_count; ++i)
    reactions[i] = {};
  Message message(error, FDCG_E_ARGUMENT);
  message.say("body ", bad);
  if (first == bad) return message.text(": has no mass; make it with fdcg_body_init");
  return message.say(": its object is that of body ", first, " too; an object is one body's: give each its own");
}

// Whether a body stands where its object's latest pose is, but for rounding.
bool is_at(const Object& object, const fdcg_pose& pose) {
  constexpr double kShare = 1e-9;  // of lengths: far above rounding, far below a tick's way
  const World translation = vec(pose.translation_m), gap = translation - vec(object.asked.translation_m);
  if (!(norm1(gap) <= kShare * (norm1(translation) + object.now.radius))) return false;
  for (int k = 0; k < 4; ++k) {
    if (!(absolute(pose.rotation_xyzw[k] - object.asked.rotation_xyzw[k]) <= kShare)) return false;
  }
  return absolute(pose.scale - object.asked.scale) <= kShare * pose.scale;
}

// A pose that was set beside the body's, and a body that was moved beside its scene, would be lost or count twice.
fdcg_status check_places(const fdcg_scene* scene, const fdcg_scene_body* bodies, uint32_t body_count, fdcg_error* error) {
  for (uint32_t i = 0; i < body_count; ++i) {
    const Object* const object = find_object(const_cast<fdcg_scene*>(scene), bodies[i].object, error);
    if (object == nullptr) return FDCG_E_ARGUMENT;
    if (is_at(*object, fdcg_body_get_pose(&bodies[i].body))) continue;
    return Message(error, FDCG_E_ARGUMENT)
        .say("body ", i, ": it is not where its object is. Either the object's pose was set, or the body was stepped or made ",
             "elsewhere; a tick moves both. Forces of your own: fdcg_body_set_push; a new place: fdcg_body_init and ",
             "fdcg_scene_set_pose");
  }
  return FDCG_OK;
}

}  // namespace

fdcg_reaction about_centre(const fdcg_body& body, const fdcg_reaction& reaction) {
  const fdcg_pose pose = fdcg_body_get_pose(&body);
  const Vector arm = vec(body.centre_m) - vec(pose.translation_m);
  fdcg_reaction moved = reaction;
  put(vec(reaction.torque_n_m) - cross(arm, vec(reaction.force_n)), moved.torque_n_m);
  return moved;
}

fdcg_status move_body(fdcg_scene* scene, fdcg_scene_body* body, const fdcg_reaction& push, double dt_s, fdcg_error* error) {
  const bool was_asleep = body->body.is_asleep != 0;
  fdcg_reaction all = push;
  put(vec(push.force_n) + vec(body->body.push_n), all.force_n);
  put(vec(push.torque_n_m) + vec(body->body.push_n_m), all.torque_n_m);
  fdcg_body_step(&body->body, all.force_n, all.torque_n_m, dt_s);
  if (was_asleep && body->body.is_asleep != 0) return FDCG_OK;  // it has not moved
  const fdcg_pose pose = fdcg_body_get_pose(&body->body);
  return fdcg_scene_set_pose(scene, body->object, &pose, error);
}

fdcg_status check_bodies(const fdcg_scene* scene, const fdcg_scene_body* bodies, uint32_t body_count, uint32_t substeps,
                         double tick_s, fdcg_reaction* reactions, uint32_t reaction_count, fdcg_error* error) {
  if (scene == nullptr || (bodies == nullptr && body_count > 0) || (reactions == nullptr && reaction_count > 0))
    return Message(error, FDCG_E_ARGUMENT).text("scene, bodies or reactions: null pointer");
  if (substeps == 0 || substeps > FDCG_BODY_MAX_SUBSTEPS) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("substeps is ", substeps, ", allowed 1 to ", FDCG_BODY_MAX_SUBSTEPS,
             substeps == 0 ? "; where fdcg_body_substeps returns 0 too many would be needed: a" : "; a",
             " shorter tick, a softer contact or a heavier body needs fewer");
  }
  constexpr double kLeastStep_s = 1e-9, kLongestStep_s = 1;  // of fdcg_body_step
  if (!(tick_s / substeps >= kLeastStep_s && tick_s / substeps <= kLongestStep_s)) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("tick_s is ", tick_s, ", allowed for each of the substeps ", kLeastStep_s, " to ", kLongestStep_s, " s");
  }
  const fdcg_status status = check_objects(bodies, body_count, reactions, reaction_count, error);
  return status == FDCG_OK ? check_places(scene, bodies, body_count, error) : status;
}

void begin_ways(fdcg_scene* scene) {
  for (uint32_t i = 0; i < scene->finger_end; ++i)
    scene->fingers()[i].goal = scene->fingers()[i].hip;
}

void move_fingers(fdcg_scene* scene, uint32_t step, uint32_t substeps) {
  const double share = 1.0 / (substeps - step);  // of the way that is left
  for (uint32_t i = 0; i < scene->finger_end; ++i) {
    Finger& finger = scene->fingers()[i];
    if (finger.is_started == 0 || !is_place(finger.goal)) continue;
    finger.hip = step + 1 < substeps ? finger.last + (finger.goal - finger.last) * share : finger.goal;
  }
}

void end_ways(fdcg_scene* scene) {
  for (uint32_t i = 0; i < scene->finger_end; ++i)
    scene->fingers()[i].hip = scene->fingers()[i].goal;
}

}  // namespace fdcg

extern "C" fdcg_status fdcg_scene_step_bodies(fdcg_scene* scene, fdcg_scene_body* bodies, uint32_t body_count,
                                              uint32_t substeps, double tick_s, fdcg_reaction* reactions,
                                              uint32_t reaction_count, fdcg_error* error) {
  fdcg_status status = fdcg::check_bodies(scene, bodies, body_count, substeps, tick_s, reactions, reaction_count, error);
  if (status != FDCG_OK) return status;
  fdcg::begin_ways(scene);
  for (uint32_t step = 0; status == FDCG_OK && step < substeps; ++step) {
    fdcg::move_fingers(scene, step, substeps);
    fdcg_scene_step(scene);
    fdcg_scene_get_reactions(scene, reactions, reaction_count);
    for (uint32_t i = 0; status == FDCG_OK && i < body_count; ++i) {
      const fdcg_reaction push = fdcg::about_centre(bodies[i].body, reactions[bodies[i].object.index]);
      status = fdcg::move_body(scene, bodies + i, push, tick_s / substeps, error);
    }
  }
  fdcg::end_ways(scene);
  return status;
}
