/* SPDX-License-Identifier: Apache-2.0 */
/* A cube of 1 cm whose corner is pulled up: it catches a finger that stands still above, and lifts its god-object. */
#include <stdio.h>
#include <stdlib.h>

#include "fdcg/deform.h"

static void check(fdcg_status status, const fdcg_error* error) {
  if (status == FDCG_OK) return;
  fprintf(stderr, "%s\n", error->message);
  exit(1);
}

int main(void) {
  static uint64_t memory[4 * 1024];
  const fdcg_deform_config config = fdcg_make_deform_config();
  const fdcg_params params = fdcg_make_params();
  const double hip_m[3] = {0.006, 0.006, 0.011}; /* 1 mm above the top */
  double vertex_m[3] = {0.01, 0.01, 0.01};
  fdcg_graph cube;
  fdcg_deform* deform;
  fdcg_error error;
  uint32_t corner;

  check(fdcg_open_file("cube_triangles.fdcg", FDCG_VERIFY_SAFE, &cube, &error), &error);
  check(fdcg_deform_create(memory, sizeof memory, &cube, &config, &deform, &error), &error);
  check(fdcg_deform_find(deform, vertex_m, &corner, &error), &error); /* once for each vertex that will move */

  fdcg_deform_contact contact = {0};
  for (int tick = 0; tick < 6; ++tick) {
    fdcg_result felt;
    vertex_m[2] = 0.01 + 0.002 * tick;
    check(fdcg_deform_move(deform, corner, vertex_m, &error), &error); /* or fdcg_deform_move_corners, many at once */
    fdcg_deform_step(deform, &params, &contact, hip_m, &felt);
    printf("tick %d: state %u, caught %d, force %.3f %.3f %.3f N\n", tick, felt.state, (felt.flags & FDCG_DEFORM_CAUGHT) != 0,
           felt.force_n[0], felt.force_n[1], felt.force_n[2]);
  }
  fdcg_close(&cube);
  return 0;
}
