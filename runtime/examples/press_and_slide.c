/* SPDX-License-Identifier: Apache-2.0 */
/* Presses on a cube of 1 cm, then slides: friction holds, gives way, and drags. */
#include <stdio.h>

#include "fdcg/fdcg.h"

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_file("cube.fdcg", FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  fdcg_params params = fdcg_make_params(); /* static friction 0.6, dynamic 0.4, 1,000 N/m */
  fdcg_contact contact = {0};              /* one contact point; keep it from tick to tick */
  fdcg_result result;
  for (int tick = 0; tick < 6; ++tick) { /* a servo loop reads its device here and writes result.force_n to it */
    const double hip_m[3] = {0.004 + 0.0003 * tick, 0.005, tick == 0 ? 0.011 : 0.009};
    fdcg_step(&graph, &params, &contact, hip_m, &result);
    printf("tick %d: state %u, slip %u, force %.3f %.3f %.3f N\n", tick, result.state, result.slipping, result.force_n[0],
           result.force_n[1], result.force_n[2]);
  }
  fdcg_close(&graph);
  return 0;
}
