/* SPDX-License-Identifier: Apache-2.0 */
/* Compiled with the headers of each build, and linked with its library into one object of which only SIDE is seen (against.py).
 * DEFAULT_PARAMS: what its header calls the function that makes them. */
#include "side.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fdcg/fdcg.h"

typedef struct {
  fdcg_graph graph;
  fdcg_params params;
  fdcg_contact contact;
  fdcg_result result;
} felt;

static void* open_side(const char* path, char* why, unsigned why_bytes) {
  fdcg_error error;
  felt* one = aligned_alloc(64, (sizeof(felt) + 63) / 64 * 64);
  memset(one, 0, sizeof *one);
  one->params = DEFAULT_PARAMS();
  if (fdcg_open_file(path, FDCG_VERIFY_FULL, &one->graph, &error) == FDCG_OK) return one;
  snprintf(why, why_bytes, "%s", error.message);
  free(one);
  return NULL;
}

static int step_side(void* contact, const double hip_m[3]) {
  felt* const one = contact;
  fdcg_step(&one->graph, &one->params, &one->contact, hip_m, &one->result);
  return one->result.state != FDCG_FREE;
}

static void restart_side(void* contact) {
  felt* const one = contact;
  memset(&one->contact, 0, sizeof one->contact);
}

static void close_side(void* contact) {
  felt* const one = contact;
  fdcg_close(&one->graph);
  free(one);
}

const side SIDE = {open_side, step_side, restart_side, close_side};
