/* SPDX-License-Identifier: Apache-2.0 */
/* The friction curve: a hand slides over a cube of 1 cm faster and faster, and friction falls as the Stribeck effect has it. */
#include <stdio.h>

#include "fdcg/fdcg.h"

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_file("cube.fdcg", FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  fdcg_params params = fdcg_make_params();
  params.friction_flags = FDCG_FRICTION_STRIBECK | FDCG_FRICTION_VISCOUS | FDCG_FRICTION_LAG | FDCG_FRICTION_PRESLIDING;
  params.stribeck_m_per_s = 0.05; /* half of the fall from mu_static to mu_dynamic is done */
  params.viscous_s_per_m = 0.1;
  if (fdcg_check_params(&params, &error) != FDCG_OK) fprintf(stderr, "%s\n", error.message);

  const double speeds_m_per_s[] = {0.001, 0.01, 0.05, 0.2};
  for (int speed = 0; speed < 4; ++speed) {
    fdcg_contact contact = {0};
    fdcg_result result = {0};
    double hip_m[3] = {0.005, 0.005, 0.011};
    fdcg_step(&graph, &params, &contact, hip_m, &result); /* above the cube */
    hip_m[2] = 0.0095;
    for (int tick = 0; tick < 1000; ++tick) { /* to and fro over 6 mm, at 1 kHz */
      const double way_m = speeds_m_per_s[speed] * tick / 1000, turn_m = way_m - 0.012 * (int)(way_m / 0.012);
      hip_m[0] = 0.002 + (turn_m < 0.006 ? turn_m : 0.012 - turn_m);
      fdcg_step(&graph, &params, &contact, hip_m, &result);
    }
    printf("%.3f m/s: slip %u, friction ratio %.3f\n", speeds_m_per_s[speed], result.slipping,
           (result.force_n[0] < 0 ? -result.force_n[0] : result.force_n[0]) / result.force_n[2]);
  }
  fdcg_close(&graph);
  return 0;
}
