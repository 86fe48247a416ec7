// SPDX-License-Identifier: Apache-2.0
// Tables of materials: a scene has copies of its objects' own, one behind the other, and no gaps between them.
#include "base/config.hpp"
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "scene/scene_memory.hpp"

namespace fdcg {

uint32_t rows_of(const fdcg_params& params) {
  return FDCG_WITH_FRICTION_TERMS && (params.friction_flags & FDCG_FRICTION_MATERIALS) != 0 ? params.material_count : 0;
}

void drop_materials(fdcg_scene* scene, Object* object) {
  settle_place(scene);
  const uint32_t count = rows_of(object->params);
  if (count == 0) return;
  fdcg_material* const first = scene->materials() + (object->params.materials - scene->materials());
  const auto after = static_cast<uint64_t>(scene->materials() + scene->material_count - (first + count));
  memmove(static_cast<void*>(first), first + count, after * sizeof(fdcg_material));
  scene->material_count -= count;
  object->params.materials = nullptr;
  object->params.material_count = 0;
  for (uint32_t i = 0; i < scene->object_end; ++i) {
    fdcg_params& other = scene->objects()[i].params;
    if (rows_of(other) > 0 && other.materials > first) other.materials -= count;
  }
}

fdcg_status take_params(fdcg_scene* scene, Object* object, const fdcg_params& params, fdcg_error* error) {
  const uint32_t count = rows_of(params), own = rows_of(object->params);
  if (count > scene->material_capacity - scene->material_count + own) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("params.material_count is ", count, ", the scene has room for ",
             scene->material_capacity - scene->material_count + own, " more; raise config.material_capacity");
  }
  // Rows that a caller read from the scene's own params are not given out: the table lies elsewhere.
  drop_materials(scene, object);
  fdcg_params room;
  object->params = in_full(params, &room, fdcg_params_init);
  object->params.materials = nullptr;
  object->params.material_count = count;
  if (count == 0) return FDCG_OK;
  fdcg_material* const rows = scene->materials() + scene->material_count;
  memcpy(static_cast<void*>(rows), params.materials, count * sizeof(fdcg_material));
  object->params.materials = rows;
  scene->material_count += count;
  return FDCG_OK;
}

void point_to_own_materials(fdcg_scene* scene) {
  const auto from = reinterpret_cast<uintptr_t>(scene->place) + scene->materials_at;
  for (uint32_t i = 0; i < scene->object_end; ++i) {
    fdcg_params& params = scene->objects()[i].params;
    if (rows_of(params) == 0) continue;
    params.materials = scene->materials() + (reinterpret_cast<uintptr_t>(params.materials) - from) / sizeof(fdcg_material);
  }
  scene->place = scene;
}

}  // namespace fdcg
