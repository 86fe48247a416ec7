// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_cone.hpp"
#include "surface/surface_drive.hpp"

extern "C" const uint32_t fdcg_linked_cylinder = FDCG_SURFACE_CYLINDER;

namespace fdcg {

void step_cylinder(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* contact, const double hip_m[3],
                   fdcg_result* result) {
  surface_drive::step_on<ConeSurface, QuickCylinder>(surface, params, contact, hip_m, result);
}
void normal_of_cylinder(const fdcg_surface& surface, const fdcg_result& result, double normal[3]) {
  surface_drive::normal_on<ConeSurface>(surface, result, normal);
}

}  // namespace fdcg
