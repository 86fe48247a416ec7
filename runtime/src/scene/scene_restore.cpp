// SPDX-License-Identifier: Apache-2.0
// A scene put into a state that was saved (docs/internals/scene-state.md). What a tick can find again is not in the state:
// which objects are near a finger, and free contacts with them (scene_step.cpp).
#include "base/message.hpp"
#include "scene/state_records.hpp"
#include "step/contact_internals.hpp"

namespace fdcg {
namespace {

void restore(const PlaceState& state, const Bounds& bounds, Pose* pose) {
  for (int k = 0; k < 3; ++k)
    pose->row[k] = vec(state.row[k]);
  pose->translation = vec(state.translation);
  pose->scale = state.scale;
  pose->is_plain = state.is_plain != 0;
  pose->centre = pose->to_world(bounds.centre, true);
  pose->radius = bounds.radius * state.scale;
}

void restore_objects(fdcg_scene* scene, const StateHeader& header, const ObjectState* objects, const fdcg_material* rows) {
  for (uint32_t i = 0; i < scene->object_end; ++i)
    drop_materials(scene, scene->objects() + i);
  scene->changing_count = 0;
  scene->object_end = header.object_count;
  scene->first_free_object = 0;
  for (uint32_t i = 0; i < header.object_count; ++i) {
    const ObjectState& state = objects[i];
    Object& object = scene->objects()[i];
    object.generation = state.generation;
    if (state.kind == kStateEmpty) continue;
    take_params(scene, &object, params_of(state, rows), nullptr);  // there is room: check_state has looked
    rows += state.material_count;
    object.is_enabled = state.is_enabled;
    object.is_changing = state.is_changing;
    if (state.is_changing != 0) scene->changing()[scene->changing_count++] = i;
    object.asked = state.asked;
    restore(state.now, object.bounds, &object.now);
    restore(state.last, object.bounds, &object.last);
    scan_object(*scene, i);
  }
  for (uint32_t i = header.object_count; i < scene->config.object_capacity; ++i)
    scene->objects()[i].generation = header.salt;
}

Turn turn_of(const TurnState& state) {
  return {vec(state.v), state.w};
}

void restore_pad(const HeldState& held, const Object* objects, SoftTouch* pad) {
  *pad = {};
  if (held.is_pad_on == 0) return;
  pad->object = {held.object, objects[held.object].generation};
  pad->is_on = 1;
  pad->is_slipping = held.is_pad_slipping;
  pad->state = held.pad_state;
  pad->feature = held.pad_feature;
  pad->reference = turn_of(held.pad_reference);
  pad->god_object = vec(held.pad_god_object_m);
  pad->normal = vec(held.pad_normal);
  pad->torque_n_m = vec(held.pad_torque_n_m);
}

void restore_finger(fdcg_scene* scene, uint32_t f, const FingerState& state, const HeldState* held, const fdcg_touch* touches) {
  Finger& finger = scene->fingers()[f];
  finger = {};
  finger.generation = state.generation;
  finger.is_used = state.is_used;
  if (state.is_used == 0) return;
  finger.hip = vec(state.hip);
  finger.last = vec(state.last);
  finger.force = vec(state.force_n);
  finger.is_started = state.is_started;
  finger.tick = state.tick;
  finger.step = state.step;
  finger.flags = state.flags;
  finger.touch_count = state.touch_count;
  finger.non_finite_steps = state.non_finite_steps;
  finger.overflowed_steps = state.overflowed_steps;
  finger.missed_ticks = state.missed_ticks;
  finger.broadphase_updates = state.broadphase_updates;
  finger.material = state.material;
  finger.has_material = state.has_material;
  finger.busy = state.held_count;
  finger.look = scene->look - 1;  // which objects are near is to be found anew
  finger.limit = -HUGE_VAL;
  const bool has_pads = scene->config.has_soft_fingers != 0;
  if (has_pads) scene->soft_fingers()[f] = {state.pad_radius_m, turn_of(state.pad_rotation)};
  for (uint32_t s = 0; s < scene->config.touches_per_finger; ++s) {
    scene->slots(f)[s] = {FDCG_NONE, 0, 0};
    if (has_pads) scene->soft_touches(f)[s] = {};
  }
  for (uint32_t i = 0; i < state.held_count; ++i) {
    scene->slots(f)[held[i].slot] = {held[i].object, 1, state.step};
    auto* const contact = part_at<fdcg_contact>(scene->first_contact(f), held[i].slot * uint64_t{scene->contact_bytes});
    *contact = held[i].contact;
    keep_no_field(&internals_of(*contact));
    if (has_pads) restore_pad(held[i], scene->objects(), scene->soft_touches(f) + held[i].slot);
  }
  for (uint32_t i = 0; i < state.touch_count; ++i)
    scene->touches(f)[i] = touches[i];
}

void restore_fingers(fdcg_scene* scene, const StateHeader& header, const void* state) {
  const StateLayout layout(header);
  const auto* const fingers = part_at<FingerState>(state, layout.fingers);
  const auto* held = part_at<HeldState>(state, layout.held);
  const auto* touches = part_at<fdcg_touch>(state, layout.touches);
  for (uint32_t f = 0; f < header.finger_count; ++f) {
    restore_finger(scene, f, fingers[f], held, touches);
    held += fingers[f].held_count;
    touches += fingers[f].touch_count;
  }
  for (uint32_t f = header.finger_count; f < scene->config.finger_capacity; ++f) {
    scene->fingers()[f].is_used = 0;
    scene->fingers()[f].generation = header.salt;
  }
  scene->finger_end = header.finger_count;
  scene->first_free_finger = 0;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_scene_restore(fdcg_scene* scene, const void* state, uint64_t bytes, fdcg_error* error) {
  using namespace fdcg;
  if (scene == nullptr || state == nullptr) return refuse(error, "scene or state: null pointer");
  if (const fdcg_status status = check_state(*scene, state, bytes, error); status != FDCG_OK) return status;
  const StateHeader& header = *static_cast<const StateHeader*>(state);
  const StateLayout layout(header);
  settle_place(scene);
  scene->salt = header.salt;
  scene->tick = header.tick;
  scene->tick_travel = header.tick_travel;
  ++scene->look;
  if (header.is_soft == 0) scene->step_soft = nullptr;
  restore_objects(scene, header, part_at<ObjectState>(state, layout.objects), part_at<fdcg_material>(state, layout.materials));
  restore_fingers(scene, header, state);
  return FDCG_OK;
}
