/* SPDX-License-Identifier: Apache-2.0 */
/* Strokes a cube of 1 cm that has ridges of 0.01 mm, 0.4 mm apart. Needs cube.fdcg in the current folder. */
#include <stdio.h>

#include "fdcg/relief.h"

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_file("cube.fdcg", FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  const double across[3] = {1, 0, 0};
  const fdcg_waves waves = fdcg_make_ridges(1e-5, 4e-4, across);
  const fdcg_relief relief = fdcg_make_relief(&waves);
  if (fdcg_check_relief(&relief, &error) != FDCG_OK) fprintf(stderr, "%s\n", error.message);

  fdcg_params params = fdcg_make_params();
  params.mu_static = params.mu_dynamic = 0;
  fdcg_contact contact = {0};
  fdcg_relief_state state = {0};
  fdcg_result felt;
  fdcg_effect_facts facts;
  for (int tick = 0; tick < 8; ++tick) {
    const double hip_m[3] = {0.004 + 0.00005 * tick, 0.005, tick == 0 ? 0.0101 : 0.0098};
    double moved_m[3];
    fdcg_relief_move(&relief, &state, hip_m, params.tick_s, moved_m);
    fdcg_step(&graph, &params, &contact, moved_m, &felt);
    fdcg_get_effect_facts(&graph, &felt, moved_m, 0, params.tick_s, &facts, &error);
    fdcg_relief_turn(&relief, &state, &facts, felt.force_n);
    printf("tick %d: height %.4f mm, force %.4f %.4f %.4f N\n", tick, 1000 * state.height_m, felt.force_n[0] + 0,
           felt.force_n[1] + 0, felt.force_n[2]);
  }
  fdcg_close(&graph);
  return 0;
}
