/* SPDX-License-Identifier: Apache-2.0 */
/* A graph that is part of the program, and a hand that comes from above to the middle of the mesh: returns 0 if it feels
 * something. */
#include "block.h"
#include "fdcg/fdcg.h"

int main(void) {
  fdcg_graph graph;
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {0};
  fdcg_result felt;
  double hip_m[3];
  int k;
  if (fdcg_open_trusted(block, sizeof block, &graph, NULL) != FDCG_OK) return 1;
  for (k = 0; k < 3; ++k)
    hip_m[k] = (graph.header->bounds_min[k] + graph.header->bounds_max[k]) * 0.5 + graph.header->origin[k];
  for (k = 0; k < 3; ++k)
    hip_m[k] *= graph.header->metres_per_unit;
  hip_m[2] += 10;
  fdcg_step(&graph, &params, &contact, hip_m, &felt);
  hip_m[2] -= 10;
  fdcg_step(&graph, &params, &contact, hip_m, &felt);
  return felt.state != FDCG_FREE && felt.force_n[2] > 0 ? 0 : 2;
}
