/* SPDX-License-Identifier: Apache-2.0 */
#include <stdio.h>

#include "fdcg/fdcg.h"
#include "first_block.h"

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_memory(first_block, sizeof first_block, FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) return 1;
  if ((uintptr_t)first_block % 64 != 0 || first_block_bytes != sizeof first_block) return 2;
  printf("library %u, nodes %u, real %u, metres per unit %g\n", fdcg_version(), graph.header->node_count,
         graph.header->real_bytes, graph.header->metres_per_unit);
  return 0;
}
