// SPDX-License-Identifier: Apache-2.0
// Surfaces as objects of a scene.
#include "fdcg/surface.h"

#include "base/struct_bytes.hpp"
#include "scene/scene_memory.hpp"
#include "surface/surface_kinds.hpp"

namespace fdcg {
namespace {

void step_surface(const Object& object, const fdcg_params* params, fdcg_contact* contact, const double hip_object_m[3],
                  fdcg_result* result) {
  fdcg_surface_step(&object.surface, params, contact, hip_object_m, result);
}
void surface_normal(const Object& object, const fdcg_result* result, double normal[3]) {
  fdcg_surface_get_normal(&object.surface, result, normal);
}

Bounds bounds_of(const fdcg_surface& s) {
  const double wide = s.radius_m > s.top_radius_m ? s.radius_m : s.top_radius_m;
  switch (s.kind) {
    case FDCG_SURFACE_PLANE:
      return Bounds::endless();
    case FDCG_SURFACE_SPHERE:
      return Bounds::around_origin({wide, wide, wide});
    case FDCG_SURFACE_CAPSULE:
      return Bounds::around_origin({wide, wide, wide + s.length_m / 2});
    case FDCG_SURFACE_TORUS:
      return Bounds::around_origin({wide + s.tube_radius_m, wide + s.tube_radius_m, s.tube_radius_m});
    case FDCG_SURFACE_CYLINDER:
    case FDCG_SURFACE_CONE:
      return Bounds::around_origin({wide, wide, s.length_m / 2});
    default:
      return Bounds::around_origin(vec(s.half_m));
  }
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_scene_add_surface(fdcg_scene* scene, const fdcg_surface* surface, const fdcg_params* params,
                                              const fdcg_pose* pose, fdcg_object_id* object, fdcg_error* error) {
  if (const fdcg_status status = fdcg_check_surface(surface, error); status != FDCG_OK) return status;
  fdcg::Object shape = {};
  fdcg_surface room;
  shape.surface = fdcg::in_full(*surface, &room, fdcg::clear_surface);
  shape.step_shape = fdcg::step_surface;
  shape.shape_normal = fdcg::surface_normal;
  shape.bounds = fdcg::bounds_of(shape.surface);
  return fdcg::add_object(scene, shape, params, pose, object, error);
}
