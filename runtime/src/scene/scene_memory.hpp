// SPDX-License-Identifier: Apache-2.0
// Layout of a scene's memory:
//
//   fdcg_scene | Object[objects] | the scan's four arrays | changing[objects] | Finger[fingers] | Slot[fingers][touches]
//   | fdcg_contact[fingers][touches] | fdcg_touch[fingers][touches] | SoftFinger[fingers] | SoftTouch[fingers][touches]
//   | fdcg_material[materials]
//
// Found by offsets from the start, so that a copy of the whole is a scene again. With config.has_deforms each contact stands in
// an fdcg_deform_contact, as its first member. Objects' parameters point to their rows among the materials: settle_place()
// makes those of a copy point into the copy.
#pragma once

#include "base/caller_memory.hpp"
#include "fdcg/deform.h"
#include "fdcg/surface.h"
#include "scene/pose.hpp"
#include "scene/soft_finger.hpp"

namespace fdcg {

// Less than any reach, and finite, so that sums with it are.
inline constexpr double kNoReach = -1e300;
// The scan's arrays are processed in runs of this length, which compilers vectorise.
inline constexpr uint32_t kRun = 16;

// Objects other than plain graphs step, and give their normal, through function pointers, so that programs without surfaces or
// deformable meshes do not link their code.
struct Object;
using ShapeStep = void(const Object&, const fdcg_params*, fdcg_contact*, const double hip_object_m[3], fdcg_result*);
using ShapeNormal = void(const Object&, const fdcg_result*, double normal[3]);
struct Finger;
using DeformStart = void(fdcg_scene&, Finger&);

struct Object {
  fdcg_graph view;            // not open: it is the surface. Of a deformable mesh its own: current where a step has just looked
  ShapeStep* step_shape;      // null: it is the graph as it is
  ShapeNormal* shape_normal;  // null: a graph's
  fdcg_deform* deform;        // null: it is none
  fdcg_surface surface;
  fdcg_params params;
  Bounds bounds;
  fdcg_pose asked;  // the latest set
  Pose now, last;   // of this tick and of the one before
  uint32_t generation;
  uint32_t is_used, is_enabled;
  uint32_t is_changing;  // not 0: listed in `changing`. 2: its pose was set since the last advance; 1: before that one

  // Null: it is a surface.
  [[nodiscard]] const fdcg_graph* graph() const { return view.header != nullptr ? &view : nullptr; }
};

// A slot of a finger for an object that it touches or that is near. Separate from the contacts, so that a finger's slots are
// contiguous.
struct Slot {
  uint32_t object;   // FDCG_NONE: empty
  uint32_t is_held;  // touched, or a sweep carried over: the contact has state that must be kept
  uint32_t step;     // of the finger, when the contact was last stepped
};

// The first 112 bytes are all that a step reads of a finger out of reach.
struct Finger {
  World hip;      // requested position
  World last;     // of the last step
  World anchor;   // its position at the last broad-phase update
  double limit;   // distance to the nearest object without a slot at that time, plus fdcg_scene.travel at that time
  uint32_t look;  // fdcg_scene.look at that time; if it has changed since, the limit is invalid
  uint32_t tick;  // of the last step
  uint32_t busy;  // slots in use
  uint32_t is_started;
  uint32_t generation, is_used;
  uint32_t step;  // counts steps
  uint32_t flags;
  uint32_t touch_count;
  uint32_t idle_steps;  // in a row, in which no slot's object was in reach
  World force;
  uint64_t non_finite_steps, overflowed_steps, missed_ticks, broadphase_updates;
  fdcg_material material;
  uint32_t has_material, reserved;
  World goal;  // in a tick of several steps: where it is to be at the end
};

}  // namespace fdcg

struct fdcg_scene {
  uint64_t bytes;
  fdcg_scene_config config;
  uint64_t objects_at, scan_at, changing_at, fingers_at, slots_at, contacts_at, touches_at;  // offsets
  uint32_t object_end, finger_end;                                                           // indices in use lie below
  uint32_t first_free_object, first_free_finger;                                             // no index below is free
  uint32_t changing_count;
  uint32_t tick;
  uint32_t look;  // changes when objects are added, removed or resized: invalidates the broad phase of every finger
  uint32_t contact_bytes;
  fdcg::SoftStep* step_soft;  // null: no finger was ever soft
  uint64_t soft_fingers_at, soft_touches_at;
  uint64_t materials_at;
  uint32_t salt, reserved;                     // where the numbers of ids begin
  uint32_t material_capacity, material_count;  // rows of materials, those in use first
  const fdcg_scene* place;                     // where the materials' pointers lead
  fdcg::DeformStart* start_on_deforms;         // null: no deformable mesh was ever added
  double tick_travel;                          // the largest move of any object in this tick
  double travel;                               // the sum of those, rounded up
  double farthest;                             // the largest |x| + |y| + |z| of any object's place: scales rounding

  fdcg::Object* objects() { return fdcg::part_at<fdcg::Object>(this, objects_at); }
  const fdcg::Object* objects() const { return fdcg::part_at<fdcg::Object>(this, objects_at); }
  // Centre x, y, z and reach of every object, array after array: the input of a broad-phase update. The reach is the bounding
  // sphere's radius plus its motion in this tick; kNoReach for objects that cannot be touched.
  double* scan(uint32_t array) { return fdcg::part_at<double>(this, scan_at) + array * scan_length(); }
  const double* scan(uint32_t array) const { return fdcg::part_at<double>(this, scan_at) + array * scan_length(); }
  uint64_t scan_length() const { return (uint64_t{config.object_capacity} + fdcg::kRun - 1) / fdcg::kRun * fdcg::kRun; }
  uint32_t* changing() { return fdcg::part_at<uint32_t>(this, changing_at); }
  fdcg::Finger* fingers() { return fdcg::part_at<fdcg::Finger>(this, fingers_at); }
  const fdcg::Finger* fingers() const { return fdcg::part_at<fdcg::Finger>(this, fingers_at); }
  fdcg::Slot* slots(uint32_t finger) {
    return fdcg::part_at<fdcg::Slot>(this, slots_at) + finger * uint64_t{config.touches_per_finger};
  }
  const fdcg::Slot* slots(uint32_t finger) const {
    return fdcg::part_at<fdcg::Slot>(this, slots_at) + finger * uint64_t{config.touches_per_finger};
  }
  // A slot's is contact_bytes behind that of the slot before it.
  fdcg_contact* first_contact(uint32_t finger) {
    return fdcg::part_at<fdcg_contact>(this, contacts_at + finger * config.touches_per_finger * uint64_t{contact_bytes});
  }
  const fdcg_contact* first_contact(uint32_t finger) const {
    return fdcg::part_at<fdcg_contact>(this, contacts_at + finger * config.touches_per_finger * uint64_t{contact_bytes});
  }
  fdcg_touch* touches(uint32_t finger) {
    return fdcg::part_at<fdcg_touch>(this, touches_at) + finger * uint64_t{config.touches_per_finger};
  }
  const fdcg_touch* touches(uint32_t finger) const {
    return fdcg::part_at<fdcg_touch>(this, touches_at) + finger * uint64_t{config.touches_per_finger};
  }
  bool skips(uint32_t what) const { return (config.disabled_optimizations & what) == 0; }
  fdcg_material* materials() { return fdcg::part_at<fdcg_material>(this, materials_at); }
  // Present if config.has_soft_fingers.
  fdcg::SoftFinger* soft_fingers() { return fdcg::part_at<fdcg::SoftFinger>(this, soft_fingers_at); }
  const fdcg::SoftFinger* soft_fingers() const { return fdcg::part_at<fdcg::SoftFinger>(this, soft_fingers_at); }
  fdcg::SoftTouch* soft_touches(uint32_t finger) {
    return fdcg::part_at<fdcg::SoftTouch>(this, soft_touches_at) + finger * uint64_t{config.touches_per_finger};
  }
  const fdcg::SoftTouch* soft_touches(uint32_t finger) const {
    return fdcg::part_at<fdcg::SoftTouch>(this, soft_touches_at) + finger * uint64_t{config.touches_per_finger};
  }
};

namespace fdcg {

// scene_advance.cpp: applies an object's latest pose. Its last pose becomes the present one or, where it is placed without a
// motion, the latest too.
void settle_object(fdcg_scene& scene, uint32_t object, bool has_way);
// ... what the broad phase knows of an object, from its present pose and its last.
void scan_object(fdcg_scene& scene, uint32_t object);

// Steps an object's contact to a place in its frame.
inline void step_object(const Object& object, const fdcg_params* params, fdcg_contact* contact, World at, fdcg_result* result) {
  const double local[3] = {at.x, at.y, at.z};
  if (object.step_shape != nullptr) return object.step_shape(object, params, contact, local, result);
  fdcg_step(&object.view, params, contact, local, result);
}

// The normal of an object at the contact of the step just done; object's frame, unit. Zero on a graph's edges and corners.
inline World object_normal(const Object& object, const fdcg_result& result) {
  if (object.shape_normal != nullptr) {
    double normal[3];
    object.shape_normal(object, &result, normal);
    return vec(normal);
  }
  return result.state == FDCG_FACE ? vec(fdcg_get_node(&object.view, result.feature).normal) : World{0, 0, 0};
}

// scene.cpp: adds an object that is like `shape` in graph, surface or deformable mesh, and bounds.
fdcg_status add_object(fdcg_scene* scene, const Object& shape, const fdcg_params* params, const fdcg_pose* pose,
                       fdcg_object_id* object, fdcg_error* error);

// scene_materials.cpp: copies the table of new parameters into the scene, in place of the object's own, which goes. A refusal,
// where the rows do not suffice, leaves all as it was.
fdcg_status take_params(fdcg_scene* scene, Object* object, const fdcg_params& params, fdcg_error* error);
uint32_t rows_of(const fdcg_params& params);  // of materials, that the scene keeps
void drop_materials(fdcg_scene* scene, Object* object);

// scene_materials.cpp: after the scene was copied to another place.
[[gnu::cold]] void point_to_own_materials(fdcg_scene* scene);
inline void settle_place(fdcg_scene* scene) {
  if (scene->place != scene) point_to_own_materials(scene);
}

// scene_pose.cpp: in range, its quaternion made unit. *pose may be `asked` itself.
fdcg_status checked_pose(const fdcg_pose* asked, fdcg_pose* pose, fdcg_error* error);
bool is_same(const fdcg_pose& a, const fdcg_pose& b);

// scene.cpp: null, with the reason in *error, unless it is in the scene.
Object* find_object(fdcg_scene* scene, fdcg_object_id id, fdcg_error* error);
Finger* find_finger(fdcg_scene* scene, fdcg_finger_id id, fdcg_error* error);

// The torque in the world that a finger's slot gives to the finger, or null where there is none.
inline const SoftTouch* soft_touch(const fdcg_scene& scene, uint32_t finger, uint32_t slot) {
  if (scene.step_soft == nullptr || (scene.fingers()[finger].flags & FDCG_FINGER_NON_FINITE) != 0) return nullptr;
  const SoftTouch* const touch = scene.soft_touches(finger) + slot;
  const Slot& held = scene.slots(finger)[slot];
  return touch->is_on != 0 && held.is_held != 0 && held.object == touch->object.index ? touch : nullptr;
}

// Largest accepted HIP coordinate: below it the squares of distances in the step stay finite.
inline constexpr double kFarthestPlace_m = 1e100;
inline bool is_place(World x) {
  return norm1(x) <= kFarthestPlace_m;
}

}  // namespace fdcg
