// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_torus.hpp"
#include "surface/surface_drive.hpp"

extern "C" const uint32_t fdcg_linked_torus = FDCG_SURFACE_TORUS;

namespace fdcg {

void step_torus(const fdcg_surface& surface, const fdcg_params& params, fdcg_contact* contact, const double hip_m[3],
                fdcg_result* result) {
  surface_drive::step_on<Torus, Torus>(surface, params, contact, hip_m, result);
}
void normal_of_torus(const fdcg_surface& surface, const fdcg_result& result, double normal[3]) {
  surface_drive::normal_on<Torus>(surface, result, normal);
}

}  // namespace fdcg
