// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_cone.hpp"
#include "surface/surface_drive.hpp"

extern "C" const uint32_t fdcg_linked_cone = FDCG_SURFACE_CONE;

namespace fdcg {

void step_cone(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* contact, const double hip_m[3],
               fdcg_result* result) {
  surface_drive::step_on<ConeSurface, QuickCone>(surface, params, contact, hip_m, result);
}
void normal_of_cone(const fdcg_surface& surface, const fdcg_result& result, double normal[3]) {
  surface_drive::normal_on<ConeSurface>(surface, result, normal);
}

}  // namespace fdcg
