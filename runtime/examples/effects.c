/* SPDX-License-Identifier: Apache-2.0 */
/* Taps a cube of 1 cm, and strokes it: a tap, viscosity, and a law of one's own on top of the contact's force. Needs cube.fdcg
 * in the current folder. */
#include <math.h>
#include <stdio.h>

#include "fdcg/effect.h"

/* Bumps 2 mm apart along x: a force against the way up, with the way down. */
static void bumps(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state, double force_n[3]) {
  (void)state;
  const double height_n = *(const double*)effect->context;
  force_n[0] = -height_n * sin(6.283185307179586 / 0.002 * facts->surface_m[0]);
}

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_file("cube.fdcg", FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  double bump_n = 0.2;
  fdcg_effect effects[3];
  effects[0] = fdcg_make_tap(1.5, 200, 0.01);
  effects[1] = fdcg_make_viscosity(1);
  effects[2] = fdcg_make_own_effect(bumps, &bump_n, 1);
  fdcg_effect_state states[3] = {0};
  fdcg_params params = fdcg_make_params();
  params.mu_static = params.mu_dynamic = 0;
  for (int i = 0; i < 3; ++i) {
    if (fdcg_check_effect(&effects[i], params.tick_s, &error) != FDCG_OK) fprintf(stderr, "%s\n", error.message);
  }

  fdcg_contact contact = {0};
  fdcg_result felt;
  fdcg_effect_facts facts;
  for (int tick = 0; tick < 8; ++tick) {
    const double hip_m[3] = {0.004 + 0.0002 * tick, 0.005, tick == 0 ? 0.0101 : 0.0098};
    fdcg_step(&graph, &params, &contact, hip_m, &felt);
    fdcg_get_effect_facts(&graph, &felt, hip_m, 0, params.tick_s, &facts, &error);
    for (int i = 0; i < 3; ++i)
      fdcg_effect_step(&effects[i], &facts, &states[i], felt.force_n);
    printf("tick %d: force %.3f %.3f %.3f N\n", tick, felt.force_n[0], felt.force_n[1], felt.force_n[2]);
  }
  fdcg_close(&graph);
  return 0;
}
