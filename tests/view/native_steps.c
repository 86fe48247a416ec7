/* SPDX-License-Identifier: Apache-2.0 */
/* native_steps GRAPH HIPS MU_STATIC MU_DYNAMIC STIFFNESS: nanoseconds a step over a path, the fastest of some passes, as the
 * page measures them. HIPS: three doubles a tick. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fdcg/fdcg.h"

enum { kPasses = 7 };

static double now_ns(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static double* read_path(const char* name, size_t* count) {
  FILE* const file = fopen(name, "rb");
  if (file == NULL) return NULL;
  fseek(file, 0, SEEK_END);
  const size_t bytes = (size_t)ftell(file);
  rewind(file);
  double* const hips = malloc(bytes);
  *count = hips == NULL ? 0 : fread(hips, 24, bytes / 24, file);
  fclose(file);
  return hips;
}

int main(int argc, char** argv) {
  fdcg_graph graph;
  fdcg_error error;
  size_t count = 0;
  double* const hips = argc == 6 ? read_path(argv[2], &count) : NULL;
  if (hips == NULL || count == 0) return 2;
  if (fdcg_open_file(argv[1], FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) return fprintf(stderr, "%s\n", error.message), 3;
  fdcg_params params = fdcg_make_params();
  params.mu_static = atof(argv[3]);
  params.mu_dynamic = atof(argv[4]);
  params.stiffness_n_per_m = atof(argv[5]);
  fdcg_result* const results = malloc(count * sizeof *results);
  if (results == NULL) return 3;
  double best = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    fdcg_contact contact;
    memset(&contact, 0, sizeof contact);
    const double before = now_ns();
    for (size_t i = 0; i < count; ++i)
      fdcg_step(&graph, &params, &contact, hips + 3 * i, results + i);
    const double spent = (now_ns() - before) / (double)count;
    if (pass == 0 || spent < best) best = spent;
  }
  printf("%.2f\n", best);
  free(results);
  free(hips);
  fdcg_close(&graph);
  return 0;
}
