// SPDX-License-Identifier: Apache-2.0
// A contact on an object of a scene, be it a graph or a surface.
#pragma once

#include "scene_memory.hpp"

namespace fdcg {

// fdcg_step or fdcg_surface_step, to a HIP in the object's frame.
inline void step_on(const Object& object, const fdcg_params& params, World hip, fdcg_contact* contact, fdcg_result* result) {
  const double local[3] = {hip.x, hip.y, hip.z};
  if (object.step_surface != nullptr) return object.step_surface(&object.surface, &params, contact, local, result);
  fdcg_step(object.graph, &params, contact, local, result);
}

// Object's frame, unit; zero where the object says none: on a graph's edges and corners.
inline World normal_on(const Object& object, const fdcg_result& result) {
  if (object.surface_normal != nullptr) {
    double normal[3];
    object.surface_normal(&object.surface, &result, normal);
    return vec(normal);
  }
  return result.state == FDCG_FACE ? vec(fdcg_get_node(object.graph, result.feature).normal) : World{0, 0, 0};
}

}  // namespace fdcg
