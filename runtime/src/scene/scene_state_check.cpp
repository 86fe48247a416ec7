// SPDX-License-Identifier: Apache-2.0
// Whether bytes are a state that a scene can be put into: every index and count in range, every number one that a tick can
// bear. Nothing is changed, and nothing is read that the sizes do not cover.
#include "base/message.hpp"
#include "fdcg/surface.h"
#include "graph/material_section.hpp"
#include "scene/state_records.hpp"
#include "step/admit.hpp"
#include "step/contact_internals.hpp"

namespace fdcg {
namespace {

constexpr double kFarthestLocal = 1e70;  // of a contact: the step looks more closely
constexpr double kLeastPad_m = 1e-9, kMostPad_m = 1e3;
constexpr uint32_t kFingerFlags = 15, kResultFlags = 63;

fdcg_status bad(fdcg_error* error, const char* noun, uint64_t index, const char* what) {
  return Message(error, FDCG_E_GRAPH).say("state: ", noun, " ", index, ": ", what);
}

// All at most `limit` in size; false for NaN.
template <int kCount>
bool are_within(const double (&numbers)[kCount], double limit) {
  bool are = true;
  for (const double x : numbers)
    are = are && absolute(x) <= limit;
  return are;
}
bool is_unit(Vec3<double> v, double w = 0) {
  return absolute(dot(v, v) + w * w - 1) <= kUnitTolerance;
}
bool is_unit(const TurnState& turn) {
  return is_unit(vec(turn.v), turn.w);
}

// ---- header ------------------------------------------------------------------------------------------------------------

fdcg_status check_header(const StateHeader& header, uint64_t bytes, fdcg_error* error) {
  if (header.magic != kStateMagic) return refuse(error, FDCG_E_MAGIC, "state: is none of a scene");
  if (header.version != kStateVersion) {
    return Message(error, FDCG_E_VERSION)
        .say("state: has version ", header.version, ", this library reads ", kStateVersion, "; save it anew");
  }
  if (header.bytes != bytes)
    return Message(error, FDCG_E_TRUNCATED).say("state: has ", header.bytes, " bytes, of which there are ", bytes);
  if (fdcg_checksum(part_at<unsigned char>(&header, kStateSummedFrom), bytes - kStateSummedFrom) != header.checksum)
    return refuse(error, FDCG_E_CHECKSUM, "state: the checksum does not match; its bytes have changed");
  return FDCG_OK;
}

fdcg_status check_capacities(const fdcg_scene& scene, const StateHeader& header, fdcg_error* error) {
  const struct {
    const char* name;
    uint64_t value, capacity;
  } counts[] = {{"object_capacity", header.object_count, scene.config.object_capacity},
                {"finger_capacity", header.finger_count, scene.config.finger_capacity},
                {"material_capacity", header.material_count, scene.material_capacity}};
  for (const auto& count : counts) {
    if (count.value > count.capacity)
      return Message(error, FDCG_E_ARGUMENT)
          .say("config.", count.name, " is ", count.capacity, ", the state needs ", count.value);
  }
  if (header.touches_per_finger != scene.config.touches_per_finger) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("config.touches_per_finger is ", scene.config.touches_per_finger, ", in the state ", header.touches_per_finger);
  }
  if (header.is_soft > 1 || !(header.tick_travel >= 0 && header.tick_travel <= Bounds::kEndless_m))
    return refuse(error, FDCG_E_GRAPH, "state: a number of its header is out of range");
  if (header.is_soft != 0 && scene.step_soft == nullptr) {
    return refuse(error, FDCG_E_ARGUMENT,
                  "scene: has no soft finger, the state has; call fdcg_scene_set_finger_radius for any finger before");
  }
  const uint64_t slots = uint64_t{header.finger_count} * header.touches_per_finger;
  const bool fits = header.held_count <= slots && header.touch_count <= slots;
  if (!fits || StateLayout(header).bytes != header.bytes)
    return refuse(error, FDCG_E_LAYOUT, "state: its counts contradict its size");
  return FDCG_OK;
}

// ---- objects -----------------------------------------------------------------------------------------------------------

bool is_place_state(const PlaceState& place) {
  bool is = are_within(place.translation, 1e12) && place.scale >= 1e-9 && place.scale <= 1e9 && place.is_plain <= 1;
  for (int i = 0; i < 3; ++i) {
    is = is && is_unit(vec(place.row[i]));
    for (int j = 0; j < i; ++j)
      is = is && absolute(dot(vec(place.row[i]), vec(place.row[j]))) <= kUnitTolerance;
  }
  const bool is_plain = place.row[0][0] == 1 && place.row[1][1] == 1 && place.row[2][2] == 1 && place.scale == 1;
  return is && (place.is_plain == 0 || is_plain);
}

fdcg_status check_object(const fdcg_scene& scene, uint32_t i, const ObjectState& state, const fdcg_material* rows,
                         uint64_t rows_left, fdcg_error* error) {
  const Object& object = scene.objects()[i];
  if (state.kind != state_kind(object) || (state.kind != kStateEmpty && state.shape != state_shape(object))) {
    const char* const what = state.kind == kStateEmpty  ? " is in the scene and not in the state; remove it first"
                             : object.is_used == 0      ? " is in the state and not in the scene; add it first"
                             : object.deform != nullptr ? " is a deformable mesh in the scene"
                                                        : " has another graph or surface than in the state";
    return Message(error, FDCG_E_ARGUMENT).say("object ", i, what);
  }
  if (state.kind == kStateEmpty) return state.material_count == 0 ? FDCG_OK : bad(error, "object", i, "materials of none");
  if (state.is_enabled > 1 || state.is_changing > 2) return bad(error, "object", i, "a flag is out of range");
  if (state.material_count > rows_left) return bad(error, "object", i, "more materials than the state has");
  const fdcg_params params = params_of(state, rows);
  if (rows_of(params) != state.material_count) return bad(error, "object", i, "materials that nothing uses");
  fdcg_pose pose;
  if (fdcg_status status = fdcg_check_params(&params, error); status != FDCG_OK) return status;
  if (fdcg_status status = checked_pose(&state.asked, &pose, error); status != FDCG_OK) return status;
  if (!is_place_state(state.now) || !is_place_state(state.last)) return bad(error, "object", i, "its place is out of range");
  return FDCG_OK;
}

fdcg_status check_objects(const fdcg_scene& scene, const StateHeader& header, const ObjectState* objects,
                          const fdcg_material* materials, fdcg_error* error) {
  uint64_t rows = 0;
  for (uint32_t i = 0; i < header.object_count; ++i) {
    const fdcg_status status = check_object(scene, i, objects[i], materials + rows, header.material_count - rows, error);
    if (status != FDCG_OK) return status;
    rows += objects[i].material_count;
  }
  if (rows != header.material_count) return refuse(error, FDCG_E_LAYOUT, "state: materials of no object");
  for (uint32_t i = header.object_count; i < scene.object_end; ++i) {
    if (scene.objects()[i].is_used != 0)
      return Message(error, FDCG_E_ARGUMENT).say("object ", i, " is in the scene and not in the state; remove it first");
  }
  return FDCG_OK;
}

// ---- fingers -----------------------------------------------------------------------------------------------------------

// How many features of each state a contact with an object may be on: those of the graph, or of the surface's kind (surface.h).
struct FeatureCounts {
  uint32_t of[4] = {0, 1, 0, 0};

  explicit FeatureCounts(const Object& object) {
    if (object.graph() != nullptr) {
      const fdcg_header& header = *object.view.header;
      set(header.node_count, header.connection_count, header.corner_count);
    } else if (object.surface.kind == FDCG_SURFACE_BOX) {
      set(6, 12, 8);
    } else if (object.surface.kind == FDCG_SURFACE_CAPSULE) {
      set(3, 0, 0);
    } else if (object.surface.kind == FDCG_SURFACE_CYLINDER || object.surface.kind == FDCG_SURFACE_CONE) {
      set(3, 2, 2);
    }
  }
  void set(uint32_t faces, uint32_t edges, uint32_t vertices) {
    of[FDCG_FACE] = faces;
    of[FDCG_EDGE] = edges;
    of[FDCG_VERTEX] = vertices;
  }
  [[nodiscard]] bool have(uint32_t state, uint32_t feature) const {
    return state == FDCG_FREE || (state <= FDCG_VERTEX && feature < of[state]);
  }
};

// Whether the nodes that reach into its clear ball are there. A field that is kept is made anew.
bool has_sound_ball(const fdcg_contact& contact, uint32_t nodes) {
  const ContactInternals& inner = internals_of(contact);
  if (inner.clear_ball.near_count > kMostNear || inner.clear_ball.lists_all > 1) return false;
  if (inner.clear_ball.near_count != 0 && (contact.state != FDCG_FREE || inner.near.of_node != 0)) return false;
  for (uint32_t i = 0; i < inner.clear_ball.near_count; ++i) {
    if (inner.near.node[i] >= nodes) return false;
  }
  return true;
}

bool is_sound(const fdcg_contact& contact, const Object& object) {
  const FeatureCounts features(object);
  const ContactInternals& inner = internals_of(contact);
  const CarriedSweep& sweep = inner.sweep;
  const bool has_features = features.have(contact.state, contact.feature) && inner.seat_state != FDCG_FACE &&
                            features.have(inner.seat_state, inner.seat_feature) && features.have(sweep.state, sweep.feature) &&
                            features.have(sweep.left_state, sweep.left_feature);
  const bool is_swept = sweep.state == FDCG_FREE || sweep.node == FDCG_NONE || sweep.node < features.of[FDCG_FACE];
  const bool has_flags = contact.started == 1 && contact.slipping <= 1 && sweep.is_carried <= 1;
  const bool has_numbers = are_within(contact.god_object, kFarthestLocal) && are_within(contact.hip, kFarthestLocal) &&
                           are_within(sweep.target, kFarthestLocal) && absolute(sweep.fraction) <= 2 &&
                           are_within(inner.clear_ball.centre, kFarthestLocal) && inner.clear_ball.radius2 >= 0 &&
                           inner.slip_m_per_s >= 0 && inner.slip_m_per_s <= kFarthestLocal && inner.stiffness_n_per_m >= 0 &&
                           inner.stiffness_n_per_m <= kFarthestLocal;
  return has_features && is_swept && has_flags && has_numbers && has_sound_ball(contact, features.of[FDCG_FACE]);
}

// What a contact with the object is marked with: nothing else may be stepped on it.
uint64_t mark_on(const Object& object) {
  if (object.graph() != nullptr) return mark_of(*object.view.header);
  return surface_mark_of(object.surface.kind, object.surface.is_hollow);
}

fdcg_status check_held(const fdcg_scene& scene, const HeldState& held, uint64_t index, const ObjectState* objects,
                       uint32_t object_count, fdcg_error* error) {
  if (held.object >= object_count || objects[held.object].kind == kStateEmpty || objects[held.object].is_enabled == 0)
    return bad(error, "contact", index, "with an object that is not there");
  const Object& object = scene.objects()[held.object];
  if (!is_sound(held.contact, object) || internals_of(held.contact).on != mark_on(object))
    return bad(error, "contact", index, "a feature or a number is out of range");
  const bool has_pad = held.is_pad_on <= 1 && held.is_pad_slipping <= 1 && is_unit(held.pad_reference) &&
                       are_within(held.pad_god_object_m, kFarthestPlace_m) && are_within(held.pad_normal, 2) &&
                       are_within(held.pad_torque_n_m, kFarthestPlace_m);
  return has_pad ? FDCG_OK : bad(error, "contact", index, "its pad is out of range");
}

fdcg_status check_finger(const FingerState& finger, uint32_t touches_per_finger, uint32_t f, fdcg_error* error) {
  if (finger.is_used == 0)
    return finger.held_count + finger.touch_count == 0 ? FDCG_OK : bad(error, "finger", f, "touches of none");
  const bool has_flags =
      finger.is_used == 1 && finger.is_started <= 1 && finger.has_material <= 1 && finger.flags <= kFingerFlags;
  const bool has_counts = finger.held_count <= touches_per_finger && finger.touch_count <= touches_per_finger;
  if (!has_flags || !has_counts) return bad(error, "finger", f, "a flag or a count is out of range");
  const bool is_pad = finger.pad_radius_m == 0 || (finger.pad_radius_m >= kLeastPad_m && finger.pad_radius_m <= kMostPad_m);
  const bool has_last = finger.is_started == 0 || is_place(vec(finger.last));
  if (!has_last || !is_pad || !is_unit(finger.pad_rotation)) return bad(error, "finger", f, "a number is out of range");
  return finger.has_material != 0 ? check_finger_material(finger.material, error) : FDCG_OK;
}

bool is_touch(const fdcg_touch& touch, uint32_t object_count) {
  return touch.object.index < object_count && touch.state <= FDCG_VERTEX && touch.slipping <= 1 && touch.flags <= kResultFlags;
}

fdcg_status check_fingers(const fdcg_scene& scene, const void* state, const StateHeader& header, fdcg_error* error) {
  const StateLayout layout(header);
  const auto* const objects = part_at<ObjectState>(state, layout.objects);
  const auto* const fingers = part_at<FingerState>(state, layout.fingers);
  const auto* const held = part_at<HeldState>(state, layout.held);
  const auto* const touches = part_at<fdcg_touch>(state, layout.touches);
  uint64_t h = 0, t = 0;
  for (uint32_t f = 0; f < header.finger_count; ++f) {
    const FingerState& finger = fingers[f];
    if (fdcg_status status = check_finger(finger, header.touches_per_finger, f, error); status != FDCG_OK) return status;
    if (finger.held_count > header.held_count - h || finger.touch_count > header.touch_count - t)
      return bad(error, "finger", f, "more contacts than the state has");
    for (uint32_t i = 0; i < finger.held_count; ++i, ++h) {
      if (held[h].slot >= header.touches_per_finger || (i > 0 && held[h].slot <= held[h - 1].slot))
        return bad(error, "contact", h, "its slot is out of range");
      const fdcg_status status = check_held(scene, held[h], h, objects, header.object_count, error);
      if (status != FDCG_OK) return status;
    }
    for (uint32_t i = 0; i < finger.touch_count; ++i, ++t) {
      if (!is_touch(touches[t], header.object_count)) return bad(error, "touch", t, "out of range");
    }
  }
  if (h != header.held_count || t != header.touch_count) return refuse(error, FDCG_E_LAYOUT, "state: contacts of no finger");
  return FDCG_OK;
}

}  // namespace

fdcg_params params_of(const ObjectState& object, const fdcg_material* rows) {
  fdcg_params params = fdcg_make_params();
  params.edge_friction = object.edge_friction;
  params.disabled_optimizations = object.disabled_optimizations;
  params.friction_flags = object.friction_flags;
  params.mu_static = object.mu_static;
  params.mu_dynamic = object.mu_dynamic;
  params.stiffness_n_per_m = object.stiffness_n_per_m;
  params.damping_n_s_per_m = object.damping_n_s_per_m;
  params.tick_s = object.tick_s;
  params.stribeck_m_per_s = object.stribeck_m_per_s;
  params.viscous_s_per_m = object.viscous_s_per_m;
  params.presliding_n_per_m = object.presliding_n_per_m;
  params.friction_lag_s = object.friction_lag_s;
  params.unique_solution_depth_m = object.unique_solution_depth_m;
  params.finger = object.finger;
  params.materials = object.material_count != 0 ? rows : nullptr;
  params.material_count = object.material_count;
  return params;
}

fdcg_status check_state(const fdcg_scene& scene, const void* state, uint64_t bytes, fdcg_error* error) {
  if (reinterpret_cast<uintptr_t>(state) % MemoryLayout::kAlignment != 0)
    return refuse(error, FDCG_E_ALIGNMENT, "state: does not start at a multiple of 8");
  if (bytes < sizeof(StateHeader)) return refuse(error, FDCG_E_TRUNCATED, "state: is shorter than its header");
  const StateHeader& header = *static_cast<const StateHeader*>(state);
  const StateLayout layout(header);
  fdcg_status status = check_header(header, bytes, error);
  if (status == FDCG_OK) status = check_capacities(scene, header, error);
  if (status == FDCG_OK) {
    status = check_objects(scene, header, part_at<ObjectState>(state, layout.objects),
                           part_at<fdcg_material>(state, layout.materials), error);
  }
  return status == FDCG_OK ? check_fingers(scene, state, header, error) : status;
}

}  // namespace fdcg
