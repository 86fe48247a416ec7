// SPDX-License-Identifier: Apache-2.0
// The facts of a contact on a graph.
#include "base/message.hpp"
#include "fdcg/effect.h"
#include "fdcg/query.h"
#include "graph/graph_view.hpp"

namespace fdcg {
namespace {

// Normal and material of what is touched; on a face, where most ticks are, without weighing its corners.
fdcg_status name_surface(const fdcg_graph* graph, const fdcg_result& result, fdcg_effect_facts* facts, fdcg_error* error) {
  if (result.state == FDCG_FACE && result.feature < graph->header->node_count) {
    with_real_of(*graph->header, [&](auto real) {
      store(widen(RigidView<decltype(real)>(*graph).node(result.feature).normal()), facts->normal);
    });
    facts->node = result.feature;
    facts->material = fdcg_get_node_material(graph, result.feature);
    return FDCG_OK;
  }
  fdcg_contact_info info = fdcg_make_contact_info();
  const fdcg_status status = fdcg_get_contact_info(graph, nullptr, nullptr, &result, facts->tick_s, &info, error);
  for (int k = 0; k < 3; ++k)
    facts->normal[k] = info.normal[k];
  facts->node = info.node;
  facts->material = info.material;
  return status;
}

fdcg_status look_for_surface(const fdcg_graph* graph, double reach_m, fdcg_effect_facts* facts, fdcg_error* error) {
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  const fdcg_status status = fdcg_find_nearest(graph, facts->hip_m, reach_m, &hit, error);
  if (status != FDCG_OK) return status == FDCG_E_ABSENT ? FDCG_OK : status;
  facts->has_surface = hit.side >= 0 ? 1 : 0;  // from inside nothing draws
  facts->node = hit.node;
  facts->material = fdcg_get_node_material(graph, hit.node);
  for (int k = 0; k < 3; ++k) {
    facts->surface_m[k] = hit.point_m[k];
    facts->normal[k] = hit.normal[k];
  }
  return FDCG_OK;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_get_effect_facts(const fdcg_graph* graph, const fdcg_result* result, const double hip_object_m[3],
                                             double reach_m, double tick_s, fdcg_effect_facts* facts, fdcg_error* error) {
  using namespace fdcg;
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not open");
  if (result == nullptr || facts == nullptr || hip_object_m == nullptr)
    return refuse(error, "result, facts or hip_object_m: null pointer");
  if (!(tick_s > 0)) return refuse(error, "tick_s", tick_s, 0, 1e9);
  const bool touches = result->state != FDCG_FREE;
  facts->tick_s = tick_s;
  facts->is_touching = facts->has_surface = touches ? 1 : 0;
  facts->is_slipping = result->slipping;
  facts->material = facts->node = FDCG_NONE;
  facts->reserved = 0;
  for (int k = 0; k < 3; ++k) {
    facts->hip_m[k] = hip_object_m[k];
    facts->surface_m[k] = result->god_object_m[k];
    facts->spring_n[k] = result->force_n[k];
    facts->normal[k] = 0;
  }
  if (touches) return name_surface(graph, *result, facts, error);
  return reach_m > 0 ? look_for_surface(graph, reach_m, facts, error) : FDCG_OK;
}
