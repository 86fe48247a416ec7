/* SPDX-License-Identifier: Apache-2.0 */
/* Shows what a renderer uploads, and which node is felt where a triangle is seen. Needs blocks.fdcg in the current folder. */
#include <stdio.h>

#include "fdcg/visual.h"

int main(void) {
  fdcg_graph graph;
  fdcg_visual visual;
  fdcg_error error;
  if (fdcg_open_file("blocks.fdcg", FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK ||
      fdcg_get_visual(&graph, &visual, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  printf("%u vertices of %u bytes, %u triangles\n", (unsigned)visual.vertex_count, (unsigned)sizeof *visual.vertices,
         (unsigned)visual.index_count / 3);
  for (uint32_t m = 0; m < visual.material_count; ++m) {
    const fdcg_visual_material* material = &visual.materials[m];
    printf("%s: draw %u indices from %u on, felt on node %u first\n", material->name, (unsigned)material->index_count,
           (unsigned)material->first_index, (unsigned)visual.nodes[material->first_index / 3]);
  }
  fdcg_close(&graph);
  return 0;
}
