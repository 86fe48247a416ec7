/* SPDX-License-Identifier: Apache-2.0 */
/* One path over the unit cube, and a hash of all forces felt on it: what every language prints. Argument: the cube's graph. */
#include <stdio.h>
#include <string.h>

#include "fdcg/fdcg.h"

int main(int argc, char** argv) {
  const fdcg_params params = fdcg_make_params();
  fdcg_graph graph;
  fdcg_error error;
  fdcg_contact contact = {0};
  uint64_t hash = 0xCBF29CE484222325u;
  if (argc != 2 || fdcg_open_file(argv[1], FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) return 1;
  for (int i = 0; i < 20000; ++i) {
    const double hip_m[3] = {(i * 7 % 1200) / 1200.0 * 1.2 - 0.1, (i % 977) / 977.0,
                             i % 4000 == 0 ? 1.1 : 0.98 + (i % 101) / 10100.0};
    fdcg_result result;
    fdcg_step(&graph, &params, &contact, hip_m, &result);
    for (int k = 0; k < 3; ++k) {
      uint64_t word;
      memcpy(&word, &result.force_n[k], sizeof word);
      hash = (hash ^ word) * 0x100000001B3u;
    }
  }
  printf("%016llx\n", (unsigned long long)hash);
  return fdcg_close(&graph) == FDCG_OK ? 0 : 2;
}
