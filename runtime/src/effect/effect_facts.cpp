// SPDX-License-Identifier: Apache-2.0
// The facts of a contact on a graph.
#include "base/message.hpp"
#include "fdcg/effect.h"
#include "fdcg/query.h"

extern "C" fdcg_status fdcg_get_effect_facts(const fdcg_graph* graph, const fdcg_result* result, const double hip_object_m[3],
                                             double reach_m, double tick_s, fdcg_effect_facts* facts, fdcg_error* error) {
  using namespace fdcg;
  if (facts == nullptr || hip_object_m == nullptr) return refuse(error, "facts or hip_object_m: null pointer");
  fdcg_contact_info info = fdcg_make_contact_info();
  fdcg_status status = fdcg_get_contact_info(graph, nullptr, nullptr, result, tick_s, &info, error);
  if (status != FDCG_OK) return status;
  *facts = fdcg_effect_facts{};
  facts->tick_s = tick_s;
  facts->material = info.material;
  facts->is_touching = facts->has_surface = result->state != FDCG_FREE ? 1 : 0;
  facts->is_slipping = result->slipping;
  for (int k = 0; k < 3; ++k) {
    facts->hip_m[k] = hip_object_m[k];
    facts->surface_m[k] = result->god_object_m[k];
    facts->normal[k] = info.normal[k];
    facts->spring_n[k] = result->force_n[k];
  }
  if (facts->is_touching != 0 || !(reach_m > 0)) return FDCG_OK;
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  status = fdcg_find_nearest(graph, hip_object_m, reach_m, &hit, error);
  if (status != FDCG_OK) return status == FDCG_E_ABSENT ? FDCG_OK : status;
  facts->has_surface = hit.side >= 0 ? 1 : 0;  // from inside nothing draws
  facts->material = fdcg_get_node_material(graph, hit.node);
  for (int k = 0; k < 3; ++k) {
    facts->surface_m[k] = hit.point_m[k];
    facts->normal[k] = hit.normal[k];
  }
  return FDCG_OK;
}
