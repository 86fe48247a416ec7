// SPDX-License-Identifier: Apache-2.0
// A scene's memory, and what comes into it and goes.
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "graph/material_section.hpp"
#include "scene/scene_memory.hpp"

namespace fdcg {
namespace {

constexpr uint32_t kUsualMaterials = 64;  // where the config says none
constexpr uint32_t kMostObjects = 1000000, kMostFingers = 10000000, kMostTouches = 32, kMostMaterials = 1000000;

// In range; *config is then whole.
fdcg_status checked_config(const fdcg_scene_config* given, fdcg_scene_config* config, fdcg_error* error) {
  if (given == nullptr) return refuse(error, "config: null pointer");
  if (const fdcg_status status =
          check_struct_bytes(given->struct_bytes, sizeof *given, "config", "; start from fdcg_make_scene_config()", error);
      status != FDCG_OK) {
    return status;
  }
  *config = in_full(*given, config, fdcg_scene_config_init);
  struct Range {
    const char* name;
    uint32_t value, low, high;
  };
  const Range ranges[] = {{"config.object_capacity", config->object_capacity, 1, kMostObjects},
                          {"config.finger_capacity", config->finger_capacity, 1, kMostFingers},
                          {"config.touches_per_finger", config->touches_per_finger, 1, kMostTouches},
                          {"config.disabled_optimizations", config->disabled_optimizations, 0, FDCG_OPT_ALL},
                          {"config.has_soft_fingers", config->has_soft_fingers, 0, 1},
                          {"config.has_deforms", config->has_deforms, 0, 1},
                          {"config.material_capacity", config->material_capacity, 0, kMostMaterials}};
  for (const Range& range : ranges) {
    if (range.value < range.low || range.value > range.high)
      return refuse(error, range.name, range.value, range.low, range.high);
  }
  return FDCG_OK;
}

// Lays the arrays out in `scene` and returns how many bytes they take. A config in range cannot overflow 64 bits.
uint64_t lay_out(const fdcg_scene_config& config, fdcg_scene* scene) {
  MemoryLayout layout;
  const uint64_t objects = config.object_capacity, fingers = config.finger_capacity,
                 slots = fingers * config.touches_per_finger;
  layout.place(1, sizeof(fdcg_scene));
  scene->objects_at = layout.place(objects, sizeof(Object));
  scene->config = config;
  scene->scan_at = layout.place(4 * scene->scan_length(), sizeof(double));
  scene->changing_at = layout.place(objects, sizeof(uint32_t));
  scene->fingers_at = layout.place(fingers, sizeof(Finger));
  scene->slots_at = layout.place(slots, sizeof(Slot));
  scene->contact_bytes = config.has_deforms != 0 ? sizeof(fdcg_deform_contact) : sizeof(fdcg_contact);
  scene->contacts_at = layout.place(slots, scene->contact_bytes);
  scene->touches_at = layout.place(slots, sizeof(fdcg_touch));
  scene->soft_fingers_at = layout.place(config.has_soft_fingers != 0 ? fingers : 0, sizeof(SoftFinger));
  scene->soft_touches_at = layout.place(config.has_soft_fingers != 0 ? slots : 0, sizeof(SoftTouch));
  scene->material_capacity = config.material_capacity != 0 ? config.material_capacity : kUsualMaterials;
  scene->materials_at = layout.place(scene->material_capacity, sizeof(fdcg_material));
  return layout.bytes();
}

// Where the numbers of a scene's ids begin: another scene's name no object of it, but for a chance of a few in 10^9.
uint32_t salt_of(const void* memory) {
  const uint64_t mixed = (reinterpret_cast<uintptr_t>(memory) / 8 + 1) * 0x9E3779B97F4A7C15u;
  return static_cast<uint32_t>(mixed >> 32);
}

// The first record that is not in use, from *first_free on, which moves up to it; null, with the reason, if there is none.
template <class Record>
Record* unused(Record* records, uint32_t* first_free, uint32_t capacity, const char* full, fdcg_error* error) {
  for (; *first_free < capacity; ++*first_free) {
    if (records[*first_free].is_used == 0) return records + *first_free;
  }
  Message(error, FDCG_E_ARGUMENT).say(full, " is ", capacity, ", and as many are in the scene");
  return nullptr;
}

template <class Record, class Id>
Record* find(Record* records, uint32_t end, Id id, const char* unknown, fdcg_error* error) {
  if (id.index < end && records[id.index].is_used != 0 && records[id.index].generation == id.generation)
    return records + id.index;
  refuse(error, unknown);
  return nullptr;
}
}  // namespace

Object* find_object(fdcg_scene* scene, fdcg_object_id id, fdcg_error* error) {
  if (scene == nullptr) {
    refuse(error, "scene: null pointer");
    return nullptr;
  }
  return find(scene->objects(), scene->object_end, id, "object: not in this scene, or removed", error);
}

namespace {

// Sets the latest pose without a motion to it, and invalidates the broad phase of every finger.
void put_in_place(fdcg_scene* scene, Object* object) {
  settle_object(*scene, static_cast<uint32_t>(object - scene->objects()), false);
  ++scene->look;
}

void start(fdcg_scene* scene, Finger* finger, World hip) {
  Slot* const slots = scene->slots(static_cast<uint32_t>(finger - scene->fingers()));
  for (uint32_t s = 0; s < scene->config.touches_per_finger; ++s) {
    slots[s] = {};
    slots[s].object = FDCG_NONE;
  }
  finger->hip = finger->last = hip;
  finger->is_started = finger->busy = finger->touch_count = finger->flags = finger->idle_steps = 0;
  finger->look = scene->look - 1;  // none yet
  finger->limit = -HUGE_VAL;
  finger->force = {0, 0, 0};
}

// Removes the object from all slots: an object added before the next step may get its index.
[[gnu::noinline]] void empty_slots_of(fdcg_scene& scene, uint32_t object) {
  for (uint32_t f = 0; f < scene.finger_end; ++f) {
    const uint32_t slot_count = scene.fingers()[f].is_used != 0 ? scene.config.touches_per_finger : 0;
    for (uint32_t s = 0; s < slot_count; ++s) {
      Slot& slot = scene.slots(f)[s];
      if (slot.object == object) slot = {FDCG_NONE, 0, slot.step};
    }
  }
}

}  // namespace

fdcg_status add_object(fdcg_scene* scene, const Object& shape, const fdcg_params* params, const fdcg_pose* pose,
                       fdcg_object_id* object, fdcg_error* error) {
  if (scene == nullptr || object == nullptr) return refuse(error, "scene or object: null pointer");
  fdcg_status status = fdcg_check_params(params, error);
  fdcg_pose checked;
  if (status == FDCG_OK) status = checked_pose(pose, &checked, error);
  if (status != FDCG_OK) return status;
  Object* const added =
      unused(scene->objects(), &scene->first_free_object, scene->config.object_capacity, "config.object_capacity", error);
  if (added == nullptr) return FDCG_E_ARGUMENT;
  if (status = take_params(scene, added, *params, error); status != FDCG_OK) return status;
  added->view = shape.view;
  added->step_shape = shape.step_shape;
  added->shape_normal = shape.shape_normal;
  added->deform = shape.deform;
  added->surface = shape.surface;
  added->bounds = shape.bounds;
  added->asked = checked;
  added->is_used = added->is_enabled = 1;
  if (++added->generation == 0) added->generation = 1;
  const uint32_t index = static_cast<uint32_t>(added - scene->objects());
  if (index >= scene->object_end) scene->object_end = index + 1;
  put_in_place(scene, added);
  *object = {index, added->generation};
  return FDCG_OK;
}

Finger* find_finger(fdcg_scene* scene, fdcg_finger_id id, fdcg_error* error) {
  if (scene == nullptr) {
    refuse(error, "scene: null pointer");
    return nullptr;
  }
  return find(scene->fingers(), scene->finger_end, id, "finger: not in this scene, or removed", error);
}

}  // namespace fdcg

using namespace fdcg;

extern "C" void fdcg_scene_config_init(fdcg_scene_config* config, uint32_t struct_bytes) {
  fdcg_scene_config defaults = {};
  defaults.object_capacity = 64;
  defaults.finger_capacity = 8;
  defaults.touches_per_finger = 4;
  fill_defaults(config, defaults, struct_bytes);
}

extern "C" uint64_t fdcg_scene_bytes(const fdcg_scene_config* config) {
  fdcg_scene scene;
  return checked_config(config, &scene.config, nullptr) == FDCG_OK ? lay_out(scene.config, &scene) : 0;
}

extern "C" fdcg_status fdcg_scene_create(void* memory, uint64_t bytes, const fdcg_scene_config* config, fdcg_scene** scene,
                                         fdcg_error* error) {
  if (scene == nullptr) return refuse(error, "scene: null pointer");
  *scene = nullptr;
  if (memory == nullptr) return refuse(error, "memory: null pointer");
  fdcg_scene layout = {};
  const fdcg_status status = checked_config(config, &layout.config, error);
  if (status != FDCG_OK) return status;
  layout.bytes = lay_out(layout.config, &layout);
  if (const fdcg_status room = check_room(memory, bytes, layout.bytes, error); room != FDCG_OK) return room;
  // Slots, contacts, touches and soft-finger data are initialised when a finger is added.
  memset(memory, 0, layout.slots_at);
  memcpy(memory, &layout, sizeof layout);
  *scene = static_cast<fdcg_scene*>(memory);
  for (uint64_t i = 0; i < layout.scan_length(); ++i)
    (*scene)->scan(3)[i] = kNoReach;
  (*scene)->place = *scene;
  (*scene)->salt = salt_of(memory);
  for (uint32_t i = 0; i < layout.config.object_capacity; ++i)
    (*scene)->objects()[i].generation = (*scene)->salt;
  for (uint32_t i = 0; i < layout.config.finger_capacity; ++i)
    (*scene)->fingers()[i].generation = (*scene)->salt;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_add_object(fdcg_scene* scene, const fdcg_graph* graph, const fdcg_params* params,
                                             const fdcg_pose* pose, fdcg_object_id* object, fdcg_error* error) {
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not open");
  Object shape = {};
  shape.view = *graph;
  shape.bounds = Bounds(*graph->header);
  return add_object(scene, shape, params, pose, object, error);
}

extern "C" fdcg_status fdcg_scene_remove_object(fdcg_scene* scene, fdcg_object_id id, fdcg_error* error) {
  Object* const object = find_object(scene, id, error);
  if (object == nullptr) return FDCG_E_ARGUMENT;
  drop_materials(scene, object);
  object->is_used = 0;
  if (id.index < scene->first_free_object) scene->first_free_object = id.index;
  put_in_place(scene, object);
  empty_slots_of(*scene, id.index);
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_set_pose(fdcg_scene* scene, fdcg_object_id id, const fdcg_pose* pose, fdcg_error* error) {
  Object* const object = find_object(scene, id, error);
  if (object == nullptr) return FDCG_E_ARGUMENT;
  fdcg_pose checked;
  const fdcg_status status = checked_pose(pose, &checked, error);
  if (status != FDCG_OK || is_same(checked, object->asked)) return status;
  object->asked = checked;
  if (object->is_changing == 0) scene->changing()[scene->changing_count++] = id.index;
  object->is_changing = 2;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_set_params(fdcg_scene* scene, fdcg_object_id id, const fdcg_params* params,
                                             fdcg_error* error) {
  Object* const object = find_object(scene, id, error);
  if (object == nullptr) return FDCG_E_ARGUMENT;
  const fdcg_status status = fdcg_check_params(params, error);
  return status == FDCG_OK ? take_params(scene, object, *params, error) : status;
}

extern "C" fdcg_status fdcg_scene_enable_object(fdcg_scene* scene, fdcg_object_id id, int is_enabled, fdcg_error* error) {
  Object* const object = find_object(scene, id, error);
  if (object == nullptr) return FDCG_E_ARGUMENT;
  if (object->is_enabled == (is_enabled != 0 ? 1u : 0u)) return FDCG_OK;
  object->is_enabled = is_enabled != 0 ? 1 : 0;
  put_in_place(scene, object);
  if (is_enabled == 0) empty_slots_of(*scene, id.index);
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_add_finger(fdcg_scene* scene, const double hip_world_m[3], fdcg_finger_id* finger,
                                             fdcg_error* error) {
  if (scene == nullptr || hip_world_m == nullptr || finger == nullptr)
    return refuse(error, "scene, hip_world_m or finger: null pointer");
  Finger* const added =
      unused(scene->fingers(), &scene->first_free_finger, scene->config.finger_capacity, "config.finger_capacity", error);
  if (added == nullptr) return FDCG_E_ARGUMENT;
  const uint32_t generation = added->generation + 1;
  *added = {};
  added->generation = generation != 0 ? generation : 1;
  added->is_used = 1;
  start(scene, added, {hip_world_m[0], hip_world_m[1], hip_world_m[2]});
  const auto index = static_cast<uint32_t>(added - scene->fingers());
  if (scene->config.has_soft_fingers != 0) {
    scene->soft_fingers()[index] = {0, {{0, 0, 0}, 1}};
    for (uint32_t s = 0; s < scene->config.touches_per_finger; ++s)
      scene->soft_touches(index)[s] = {};
  }
  if (index >= scene->finger_end) scene->finger_end = index + 1;
  *finger = {index, added->generation};
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_remove_finger(fdcg_scene* scene, fdcg_finger_id id, fdcg_error* error) {
  Finger* const finger = find_finger(scene, id, error);
  if (finger == nullptr) return FDCG_E_ARGUMENT;
  finger->is_used = 0;
  if (id.index < scene->first_free_finger) scene->first_free_finger = id.index;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_move_finger(fdcg_scene* scene, fdcg_finger_id id, const double hip_world_m[3],
                                              fdcg_error* error) {
  Finger* const finger = find_finger(scene, id, error);
  if (finger == nullptr) return FDCG_E_ARGUMENT;
  if (hip_world_m == nullptr) return refuse(error, "hip_world_m: null pointer");
  finger->hip = {hip_world_m[0], hip_world_m[1], hip_world_m[2]};
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_set_finger_material(fdcg_scene* scene, fdcg_finger_id id, const fdcg_material* material,
                                                      fdcg_error* error) {
  Finger* const finger = find_finger(scene, id, error);
  if (finger == nullptr) return FDCG_E_ARGUMENT;
  if (material != nullptr) {
    if (const fdcg_status status = check_finger_material(*material, error); status != FDCG_OK) return status;
    finger->material = *material;
  }
  finger->has_material = material != nullptr ? 1 : 0;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_reset_finger(fdcg_scene* scene, fdcg_finger_id id, const double hip_world_m[3],
                                               fdcg_error* error) {
  Finger* const finger = find_finger(scene, id, error);
  if (finger == nullptr) return FDCG_E_ARGUMENT;
  if (hip_world_m == nullptr) return refuse(error, "hip_world_m: null pointer");
  start(scene, finger, {hip_world_m[0], hip_world_m[1], hip_world_m[2]});
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_get_result(const fdcg_scene* scene, fdcg_finger_id id, fdcg_finger_result* result,
                                             fdcg_error* error) {
  const Finger* const finger = find_finger(const_cast<fdcg_scene*>(scene), id, error);
  if (finger == nullptr) return FDCG_E_ARGUMENT;
  if (result == nullptr) return refuse(error, "result: null pointer");
  *result = {{finger->force.x, finger->force.y, finger->force.z},
             finger->flags,
             finger->touch_count,
             scene->touches(id.index),
             finger->non_finite_steps,
             finger->overflowed_steps,
             finger->missed_ticks,
             finger->broadphase_updates};
  return FDCG_OK;
}

extern "C" void fdcg_scene_get_reactions(const fdcg_scene* scene, fdcg_reaction* reactions, uint32_t count) {
  for (uint32_t i = 0; reactions != nullptr && i < count; ++i)
    reactions[i] = {};
  if (scene == nullptr || reactions == nullptr) return;
  for (uint32_t f = 0; f < scene->finger_end; ++f) {
    if (scene->fingers()[f].is_used == 0) continue;
    for (uint32_t i = 0; i < scene->fingers()[f].touch_count; ++i) {
      const fdcg_touch& touch = scene->touches(f)[i];
      if (touch.object.index >= count) continue;
      const World force = vec(touch.force_n) * -1.0;
      const World arm = vec(touch.god_object_m) - scene->objects()[touch.object.index].now.translation;
      const World torque = cross(arm, force);
      fdcg_reaction& sum = reactions[touch.object.index];
      const double add[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
      for (int k = 0; k < 3; ++k) {
        sum.force_n[k] += add[k];
        sum.torque_n_m[k] += add[k + 3];
      }
    }
    for (uint32_t slot = 0; scene->step_soft != nullptr && slot < scene->config.touches_per_finger; ++slot) {
      const SoftTouch* const soft = soft_touch(*scene, f, slot);
      if (soft == nullptr || soft->object.index >= count) continue;
      fdcg_reaction& sum = reactions[soft->object.index];
      sum.torque_n_m[0] -= soft->torque_n_m.x;
      sum.torque_n_m[1] -= soft->torque_n_m.y;
      sum.torque_n_m[2] -= soft->torque_n_m.z;
    }
  }
}
