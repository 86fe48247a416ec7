/* SPDX-License-Identifier: Apache-2.0 */
/* The runtime's headers are C11, and a C program needs nothing else. Run with a file: prints its first tick's force. */
#include "fdcg/fdcg.h"

#include <stdio.h>

int main(int argc, char** argv) {
  fdcg_graph graph;
  fdcg_error error;
  fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {0};
  fdcg_result result;
  const double outside[3] = {0.5, 0.5, 1.5}, inside[3] = {0.5, 0.5, 0.75};
  if (argc != 2 || fdcg_check_params(&params, &error) != FDCG_OK) return 2;
  if (fdcg_open_file(argv[1], FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) return 3;
  fdcg_step(&graph, &params, &contact, outside, &result);
  fdcg_step(&graph, &params, &contact, inside, &result);
  printf("%g %g %g\n", result.force_n[0], result.force_n[1], result.force_n[2]);
  fdcg_close(&graph);
  return 0;
}
