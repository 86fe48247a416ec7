/* SPDX-License-Identifier: Apache-2.0 */
/* Steps one contact over a graph and prints every bit of what it felt: the same bytes from every compiler. C11, so that the
 * headers are checked as C too. Usage: step_log GRAPH.fdcg TICKS */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fdcg/fdcg.h"

static uint64_t bits(double x) {
  uint64_t word;
  memcpy(&word, &x, sizeof word);
  return word;
}

static double next_uniform(uint64_t* state) {
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return (double)(*state >> 11) * 0x1p-53;
}

/* A jump into the bounds now and then, small steps in between: free space, faces, edges, corners, friction both ways. */
static void move_hip(const fdcg_header* header, uint64_t* random, long tick, double hip[3]) {
  const double step = tick % 3 == 0 ? 0.02 : 0.003;
  for (int k = 0; k < 3; ++k) {
    const double size = header->bounds_max[k] - header->bounds_min[k];
    const double r = next_uniform(random);
    if (tick % 500 == 0) {
      hip[k] = (header->bounds_min[k] + (1.2 * r - 0.1) * size + header->origin[k]) * header->metres_per_unit;
    } else {
      hip[k] += (r - 0.5) * step * size * header->metres_per_unit;
    }
  }
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: step_log GRAPH.fdcg TICKS\n");
    return 2;
  }
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_file(argv[1], FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 3;
  }
  fdcg_params params = fdcg_default_params();
  fdcg_contact contact;
  memset(&contact, 0, sizeof contact);
  uint64_t random = 88172645463325252u;
  double hip[3] = {0, 0, 0};
  const long ticks = atol(argv[2]);
  for (long tick = 0; tick < ticks; ++tick) {
    if (tick % 5000 == 0) {
      params.mu_static = tick / 5000 % 3 * 0.3;
      params.mu_dynamic = params.mu_static * 0.7;
      params.edge_friction = tick / 5000 % 2 == 0 ? FDCG_EDGE_WEDGE : FDCG_EDGE_PAPER;
      params.damping_n_s_per_m = tick / 5000 % 2;
    }
    move_hip(graph.header, &random, tick, hip);
    fdcg_result result;
    fdcg_step(&graph, &params, &contact, hip, &result);
    for (int k = 0; k < 3; ++k) printf("%016" PRIx64 " %016" PRIx64 " ", bits(result.god_object_m[k]), bits(result.force_n[k]));
    printf("%u %u %u %u %u\n", result.state, result.feature, result.slipping, result.transitions, result.flags);
  }
  fdcg_close(&graph);
  return 0;
}
