// SPDX-License-Identifier: Apache-2.0
// A scene's state as bytes (docs/internals/scene-state.md).
#include "base/message.hpp"
#include "scene/state_records.hpp"
#include "step/contact_internals.hpp"

namespace fdcg {
namespace {

StateHeader header_of(const fdcg_scene& scene) {
  StateHeader header = {};
  header.magic = kStateMagic;
  header.version = kStateVersion;
  header.touches_per_finger = scene.config.touches_per_finger;
  header.object_count = scene.object_end;
  header.material_count = scene.material_count;
  header.finger_count = scene.finger_end;
  for (uint32_t f = 0; f < scene.finger_end; ++f) {
    const Finger& finger = scene.fingers()[f];
    if (finger.is_used == 0) continue;
    header.touch_count += finger.touch_count;
    for (uint32_t s = 0; s < scene.config.touches_per_finger; ++s)
      header.held_count += scene.slots(f)[s].is_held;
  }
  header.salt = scene.salt;
  header.tick = scene.tick;
  header.is_soft = scene.step_soft != nullptr ? 1 : 0;
  header.tick_travel = scene.tick_travel;
  header.bytes = StateLayout(header).bytes;
  return header;
}

PlaceState state_of(const Pose& pose) {
  PlaceState state;
  for (int k = 0; k < 3; ++k)
    store(pose.row[k], state.row[k]);
  store(pose.translation, state.translation);
  state.scale = pose.scale;
  state.is_plain = pose.is_plain ? 1 : 0;
  return state;
}

TurnState state_of(const Turn& turn) {
  return {{turn.v.x, turn.v.y, turn.v.z}, turn.w};
}

ObjectState state_of(const Object& object) {
  ObjectState state = {};
  state.generation = object.generation;
  state.kind = state_kind(object);
  if (state.kind == kStateEmpty) return state;
  const fdcg_params& params = object.params;
  state.shape = state_shape(object);
  state.is_enabled = object.is_enabled;
  state.is_changing = object.is_changing;
  state.edge_friction = params.edge_friction;
  state.disabled_optimizations = params.disabled_optimizations;
  state.friction_flags = params.friction_flags;
  state.material_count = rows_of(params);
  state.mu_static = params.mu_static;
  state.mu_dynamic = params.mu_dynamic;
  state.stiffness_n_per_m = params.stiffness_n_per_m;
  state.damping_n_s_per_m = params.damping_n_s_per_m;
  state.tick_s = params.tick_s;
  state.stribeck_m_per_s = params.stribeck_m_per_s;
  state.viscous_s_per_m = params.viscous_s_per_m;
  state.presliding_n_per_m = params.presliding_n_per_m;
  state.friction_lag_s = params.friction_lag_s;
  state.unique_solution_depth_m = params.unique_solution_depth_m;
  state.finger = params.finger;
  state.asked = object.asked;
  state.now = state_of(object.now);
  state.last = state_of(object.last);
  return state;
}

FingerState state_of(const fdcg_scene& scene, uint32_t f) {
  const Finger& finger = scene.fingers()[f];
  FingerState state = {};
  state.generation = finger.generation;
  state.is_used = finger.is_used;
  if (finger.is_used == 0) return state;
  state.is_started = finger.is_started;
  state.has_material = finger.has_material;
  state.tick = finger.tick;
  state.step = finger.step;
  state.flags = finger.flags;
  state.touch_count = finger.touch_count;
  for (uint32_t s = 0; s < scene.config.touches_per_finger; ++s)
    state.held_count += scene.slots(f)[s].is_held;
  store(finger.hip, state.hip);
  store(finger.last, state.last);
  store(finger.force, state.force_n);
  state.non_finite_steps = finger.non_finite_steps;
  state.overflowed_steps = finger.overflowed_steps;
  state.missed_ticks = finger.missed_ticks;
  state.broadphase_updates = finger.broadphase_updates;
  if (finger.has_material != 0) state.material = finger.material;
  const SoftFinger pad = scene.config.has_soft_fingers != 0 ? scene.soft_fingers()[f] : SoftFinger{0, {{0, 0, 0}, 1}};
  state.pad_radius_m = pad.radius_m;
  state.pad_rotation = state_of(pad.rotation);
  return state;
}

HeldState state_of(const fdcg_scene& scene, uint32_t f, uint32_t s) {
  HeldState state = {};
  state.slot = s;
  state.object = scene.slots(f)[s].object;
  state.contact = *part_at<fdcg_contact>(scene.first_contact(f), s * uint64_t{scene.contact_bytes});
  keep_no_field(&internals_of(state.contact));
  state.pad_reference.w = 1;
  const SoftTouch* const pad = soft_touch(scene, f, s);
  if (pad == nullptr) return state;
  state.is_pad_on = 1;
  state.is_pad_slipping = pad->is_slipping;
  state.pad_state = pad->state;
  state.pad_feature = pad->feature;
  state.pad_reference = state_of(pad->reference);
  store(pad->god_object, state.pad_god_object_m);
  store(pad->normal, state.pad_normal);
  store(pad->torque_n_m, state.pad_torque_n_m);
  return state;
}

// The objects' rows of materials, in the objects' order. In a scene that was copied, params still point to where it was.
void save_materials(const fdcg_scene& scene, fdcg_material* rows) {
  const auto from = reinterpret_cast<uintptr_t>(scene.place) + scene.materials_at;
  for (uint32_t i = 0; i < scene.object_end; ++i) {
    const fdcg_params& params = scene.objects()[i].params;
    const uint32_t count = rows_of(params);
    if (count == 0) continue;
    const auto* const own =
        part_at<fdcg_material>(&scene, scene.materials_at + (reinterpret_cast<uintptr_t>(params.materials) - from));
    memcpy(static_cast<void*>(rows), own, count * sizeof *rows);
    rows += count;
  }
}

void save(const fdcg_scene& scene, const StateHeader& header, void* state) {
  const StateLayout layout(header);
  for (uint32_t i = 0; i < header.object_count; ++i)
    part_at<ObjectState>(state, layout.objects)[i] = state_of(scene.objects()[i]);
  save_materials(scene, part_at<fdcg_material>(state, layout.materials));
  auto* held = part_at<HeldState>(state, layout.held);
  auto* touches = part_at<fdcg_touch>(state, layout.touches);
  for (uint32_t f = 0; f < header.finger_count; ++f) {
    part_at<FingerState>(state, layout.fingers)[f] = state_of(scene, f);
    const Finger& finger = scene.fingers()[f];
    if (finger.is_used == 0) continue;
    for (uint32_t s = 0; s < scene.config.touches_per_finger; ++s) {
      if (scene.slots(f)[s].is_held != 0) *held++ = state_of(scene, f, s);
    }
    for (uint32_t i = 0; i < finger.touch_count; ++i)
      *touches++ = scene.touches(f)[i];
  }
}

}  // namespace
}  // namespace fdcg

extern "C" uint64_t fdcg_scene_state_bytes(const fdcg_scene* scene) {
  return scene == nullptr ? 0 : fdcg::header_of(*scene).bytes;
}

extern "C" fdcg_status fdcg_scene_save(const fdcg_scene* scene, void* state, uint64_t bytes, fdcg_error* error) {
  using namespace fdcg;
  if (scene == nullptr || state == nullptr) return refuse(error, "scene or state: null pointer");
  for (uint32_t i = 0; i < scene->object_end; ++i) {
    if (scene->objects()[i].is_used == 0 || scene->objects()[i].deform == nullptr) continue;
    return Message(error, FDCG_E_ARGUMENT)
        .say("object ", i, " is a deformable mesh, whose state lies outside of the scene; remove it first");
  }
  StateHeader header = header_of(*scene);
  if (const fdcg_status room = check_room(state, bytes, header.bytes, error, "the scene's state"); room != FDCG_OK) return room;
  save(*scene, header, state);
  memcpy(state, &header, sizeof header);
  header.checksum = fdcg_checksum(part_at<unsigned char>(state, kStateSummedFrom), header.bytes - kStateSummedFrom);
  memcpy(state, &header, sizeof header);
  return FDCG_OK;
}
