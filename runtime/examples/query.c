/* SPDX-License-Identifier: Apache-2.0 */
/* Asks a cube of 1 cm for distances, what a ray meets, and what a contact is on. Needs cube.fdcg in the current folder. */
#include <stdio.h>

#include "fdcg/query.h"

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_file("cube.fdcg", FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  const double outside_m[3] = {0.013, 0.014, 0.005}, inside_m[3] = {0.002, 0.005, 0.005}, down[3] = {0, 0, -1};
  const double above_m[3] = {0.002, 0.005, 0.03};
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  fdcg_find_nearest(&graph, outside_m, 1, &hit, &error);
  printf("nearest: state %u, %.1f mm away\n", hit.state, 1000 * hit.distance_m);
  double distance_m;
  fdcg_get_signed_distance(&graph, inside_m, &distance_m, &error);
  printf("inside: %.1f mm\n", 1000 * distance_m);
  fdcg_cast_ray(&graph, above_m, down, 1, &hit, &error);
  printf("ray: meets the side %d of face %u after %.1f mm\n", hit.side, hit.node, 1000 * hit.distance_m);

  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {0};
  fdcg_result before = {0}, now = {0};
  fdcg_contact_info info = fdcg_make_contact_info();
  for (int tick = 0; tick < 6; ++tick) {
    const double hip_m[3] = {0.004 + 0.0003 * tick, 0.005, tick == 0 ? 0.011 : 0.009};
    before = now;
    fdcg_step(&graph, &params, &contact, hip_m, &now);
    fdcg_get_contact_info(&graph, NULL, &before, &now, params.tick_s, &info, &error);
    if ((info.events & FDCG_EVENT_BEGAN) != 0) printf("tick %d: touches\n", tick);
    if ((info.events & FDCG_EVENT_SLIP_BEGAN) != 0) printf("tick %d: slips\n", tick);
  }
  printf("at %.2f m/s, normal %.0f %.0f %.0f\n", info.slip_m_per_s[0], info.normal[0], info.normal[1], info.normal[2]);
  fdcg_close(&graph);
  return 0;
}
