// SPDX-License-Identifier: Apache-2.0
// The byte form of a scene's state (docs/internals/scene-state.md): a header, then arrays of records, each without padding:
//
//   StateHeader | ObjectState[] | fdcg_material[] | FingerState[] | HeldState[] | fdcg_touch[]
//
// Held contacts and touches stand in the order of their fingers.
#pragma once

#include "fdcg/scene_state.h"
#include "scene/scene_memory.hpp"

namespace fdcg {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the form is little-endian and read in place");

inline constexpr uint64_t kStateMagic = 0x5441'5453'4743'4446;  // "FDCGSTAT"
inline constexpr uint32_t kStateVersion = 2;

struct StateHeader {
  uint64_t magic;
  uint32_t version, touches_per_finger;
  uint64_t bytes;     // of the whole state
  uint64_t checksum;  // fdcg_checksum of all that follows this field
  uint32_t object_count, material_count, finger_count, held_count, touch_count;
  uint32_t salt;  // where the numbers of ids begin
  uint32_t tick;
  uint32_t is_soft;  // some finger was given a radius
  double tick_travel;
};
inline constexpr uint64_t kStateSummedFrom = 32;
static_assert(sizeof(StateHeader) == 72 && offsetof(StateHeader, object_count) == kStateSummedFrom);

// A unit quaternion: x, y, z, w.
struct TurnState {
  double v[3], w;
};

// A pose as the step uses it: rows of the rotation matrix.
struct PlaceState {
  double row[3][3];
  double translation[3];
  double scale;
  uint64_t is_plain;
};
static_assert(sizeof(PlaceState) == 112);

enum StateKind : uint32_t { kStateEmpty = 0, kStateGraph = 1, kStateSurface = 2, kStateDeform = 3 };  // the last is refused

struct ObjectState {
  uint32_t generation;
  uint32_t kind;   // StateKind; of kStateEmpty only the generation counts
  uint64_t shape;  // the graph's header checksum, or fdcg_checksum of the surface from its kind on
  uint32_t is_enabled;
  uint32_t is_changing;  // scene_memory.hpp
  uint32_t edge_friction, disabled_optimizations, friction_flags;
  uint32_t material_count;  // of the rows, in the objects' order
  double mu_static, mu_dynamic, stiffness_n_per_m, damping_n_s_per_m, tick_s;
  double stribeck_m_per_s, viscous_s_per_m, presliding_n_per_m, friction_lag_s, unique_solution_depth_m;
  fdcg_material finger;
  fdcg_pose asked;
  PlaceState now, last;
};
static_assert(sizeof(ObjectState) == 432);

struct FingerState {
  uint32_t generation;
  uint32_t is_used;  // 0: only the generation counts
  uint32_t is_started;
  uint32_t has_material;
  uint32_t tick, step;
  uint32_t flags;
  uint32_t held_count, touch_count;
  uint32_t reserved;
  double hip[3], last[3], force_n[3];
  uint64_t non_finite_steps, overflowed_steps, missed_ticks, broadphase_updates;
  fdcg_material material;
  double pad_radius_m;
  TurnState pad_rotation;
};
static_assert(sizeof(FingerState) == 208);

// A contact with an object that a finger touches, or on whose way a sweep is carried over.
struct HeldState {
  uint32_t slot, object;
  fdcg_contact contact;
  uint32_t is_pad_on, is_pad_slipping, pad_state, pad_feature;  // of a soft finger
  TurnState pad_reference;
  double pad_god_object_m[3], pad_normal[3], pad_torque_n_m[3];
};
static_assert(sizeof(fdcg_contact) == 304 && sizeof(fdcg_touch) == 80 && sizeof(fdcg_material) == 24);
static_assert(sizeof(HeldState) == 432);

// Offsets of the parts of a state with such counts, which are in the range of a scene's config.
struct StateLayout {
  uint64_t objects, materials, fingers, held, touches, bytes;

  explicit StateLayout(const StateHeader& header) {
    objects = sizeof(StateHeader);
    materials = objects + uint64_t{header.object_count} * sizeof(ObjectState);
    fingers = materials + uint64_t{header.material_count} * sizeof(fdcg_material);
    held = fingers + uint64_t{header.finger_count} * sizeof(FingerState);
    touches = held + uint64_t{header.held_count} * sizeof(HeldState);
    bytes = touches + uint64_t{header.touch_count} * sizeof(fdcg_touch);
  }
};

// What a state calls an object's shape.
inline uint32_t state_kind(const Object& object) {
  return object.is_used == 0         ? kStateEmpty
         : object.deform != nullptr  ? kStateDeform
         : object.graph() != nullptr ? kStateGraph
                                     : kStateSurface;
}
inline uint64_t state_shape(const Object& object) {
  if (object.is_used == 0) return 0;
  if (object.graph() != nullptr) return object.view.header->header_checksum;
  return fdcg_checksum(&object.surface.kind, sizeof object.surface - offsetof(fdcg_surface, kind));
}

// scene_state_check.cpp: whether the whole of a state is one that the scene can be put into. Changes nothing.
fdcg_status check_state(const fdcg_scene& scene, const void* state, uint64_t bytes, fdcg_error* error);

// The parameters of an object, with its rows of materials; what a library without friction terms does not know is left out.
fdcg_params params_of(const ObjectState& object, const fdcg_material* rows);

}  // namespace fdcg
