// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_drive.hpp"
#include "surface/surface_round.hpp"

extern "C" const uint32_t fdcg_linked_plane = FDCG_SURFACE_PLANE;

namespace fdcg {

void step_plane(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* contact, const double hip_m[3],
                fdcg_result* result) {
  surface_drive::step_on<PlaneSurface, PlaneSurface>(surface, params, contact, hip_m, result);
}
void normal_of_plane(const fdcg_surface& surface, const fdcg_result& result, double normal[3]) {
  surface_drive::normal_on<PlaneSurface>(surface, result, normal);
}

}  // namespace fdcg
