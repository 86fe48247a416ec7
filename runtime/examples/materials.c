/* SPDX-License-Identifier: Apache-2.0 */
/* A bar that is half steel, half rubber: what each feels like is said in a table by material. */
#include <stdio.h>

#include "fdcg/fdcg.h"

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_file("steel_and_rubber.fdcg", FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  fdcg_params params = fdcg_make_params();
  fdcg_material table[8]; /* by number; an entry of zeros would have no stiffness, and not be felt */
  const fdcg_material plain = {params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
  for (int i = 0; i < 8; ++i)
    table[i] = plain;
  const uint32_t rubber = fdcg_find_material(&graph, "rubber");
  if (rubber < 8) table[rubber] = (fdcg_material){.mu_static = 0.9, .mu_dynamic = 0.7, .stiffness_n_per_m = 600};
  params.materials = table;
  params.material_count = 8; /* materials beyond are as mu_static, mu_dynamic and stiffness_n_per_m say */
  params.friction_flags |= FDCG_FRICTION_MATERIALS;
  if (fdcg_check_params(&params, &error) != FDCG_OK) fprintf(stderr, "%s\n", error.message);

  fdcg_contact contact = {0};
  fdcg_result result;
  for (int tick = 0; tick < 8; ++tick) { /* down onto the steel, and along the bar to the rubber */
    const double hip_m[3] = {0.002 + 0.002 * tick, 0.005, tick == 0 ? 0.011 : 0.009};
    fdcg_step(&graph, &params, &contact, hip_m, &result);
    const char* name =
        result.state == FDCG_FACE ? fdcg_get_material_name(&graph, fdcg_get_node_material(&graph, result.feature)) : "none";
    printf("tick %d: %s, force %.3f %.3f %.3f N\n", tick, name, result.force_n[0], result.force_n[1], result.force_n[2]);
  }
  fdcg_close(&graph);
  return 0;
}
