/* SPDX-License-Identifier: Apache-2.0 */
/* A hand 10 mm deep in a sphere: returns 0 if it feels the spring. */
#include "fdcg/surface.h"

int main(void) {
  const double outside_m[3] = {0, 0, 0.06}, inside_m[3] = {0, 0, 0.04};
  const fdcg_surface ball = fdcg_make_sphere(0.05);
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {0};
  fdcg_result felt;
  if (fdcg_check_surface(&ball, NULL) != FDCG_OK) return 1;
  fdcg_surface_step(&ball, &params, &contact, outside_m, &felt);
  fdcg_surface_step(&ball, &params, &contact, inside_m, &felt);
  return felt.force_n[2] > 0.0099 * params.stiffness_n_per_m ? 0 : 2;
}
