/* SPDX-License-Identifier: Apache-2.0 */
/* What python_test.py compares with: a path stepped in C. Arguments: graph, path (doubles, three a tick). Prints seconds of
 * processor time for fdcg_step in a loop, for fdcg_step_path, and the sum of forces. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fdcg/query.h"

static double spent_s(void) {
  struct timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static double* read_path(const char* name, long* ticks) {
  FILE* file = fopen(name, "rb");
  double* hips = NULL;
  long bytes;
  if (file == NULL) return NULL;
  fseek(file, 0, SEEK_END);
  bytes = ftell(file);
  rewind(file);
  hips = malloc((size_t)bytes);
  *ticks = bytes / 24;
  if (hips != NULL && fread(hips, 1, (size_t)bytes, file) != (size_t)bytes) *ticks = 0;
  fclose(file);
  return hips;
}

int main(int argc, char** argv) {
  const fdcg_params params = fdcg_make_params();
  fdcg_graph graph;
  fdcg_error error;
  long ticks = 0;
  double* hips = argc == 3 ? read_path(argv[2], &ticks) : NULL;
  fdcg_result* results = calloc((size_t)ticks + 1, sizeof *results);
  double best[2] = {1e9, 1e9}, sum = 0;
  if (hips == NULL || results == NULL || fdcg_open_file(argv[1], FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) return 1;
  for (int round = 0; round < 10; ++round) {
    fdcg_contact contact = {0};
    double begin = spent_s(), took;
    if (round % 2 == 0) {
      for (long i = 0; i < ticks; ++i)
        fdcg_step(&graph, &params, &contact, hips + 3 * i, results + i);
    } else {
      fdcg_step_path(&graph, &params, &contact, hips, results, (uint64_t)ticks);
    }
    took = spent_s() - begin;
    if (took < best[round % 2]) best[round % 2] = took;
  }
  for (long i = 0; i < ticks; ++i)
    sum += results[i].force_n[0] + results[i].force_n[1] + results[i].force_n[2];
  printf("%.9f %.9f %.17g\n", best[0], best[1], sum);
  return 0;
}
