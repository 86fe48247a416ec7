// SPDX-License-Identifier: Apache-2.0
// Many steps in one call.
#include "fdcg/query.h"

extern "C" void fdcg_step_path(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact,
                               const double* hips_object_m, fdcg_result* results, uint64_t count) {
  for (uint64_t i = 0; i < count; ++i)
    fdcg_step(graph, params, contact, hips_object_m + 3 * i, results + i);
}

extern "C" void fdcg_step_many(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contacts,
                               const double* hips_object_m, fdcg_result* results, uint64_t count) {
  for (uint64_t i = 0; i < count; ++i)
    fdcg_step(graph, params, contacts + i, hips_object_m + 3 * i, results + i);
}
