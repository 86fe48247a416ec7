// SPDX-License-Identifier: Apache-2.0
// What a contact is on, from its results.
#include "base/config.hpp"
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "fdcg/query.h"
#include "query/surface_search.hpp"

namespace fdcg {

QueryPoint normal_at(const fdcg_graph& graph, uint32_t state, uint32_t feature) {
  if (state == FDCG_FACE) return vec(fdcg_get_node(&graph, feature).normal);
  QueryPoint sum = {0, 0, 0};
  if (state == FDCG_VERTEX) sum = vec(fdcg_get_corner(&graph, feature).normal);
  if (state == FDCG_EDGE) {
    const fdcg_connection_info edge = fdcg_get_connection(&graph, feature);
    for (const uint32_t node : edge.node) {
      if (node != FDCG_NONE) sum = sum + vec(fdcg_get_node(&graph, node).normal);
    }
  }
  const double length = norm(sum);
  return length > 0 ? sum * (1 / length) : sum;
}

namespace {

bool is_of(const fdcg_header& header, uint32_t state, uint32_t feature) {
  const uint32_t count[] = {0, header.node_count, header.connection_count, header.corner_count};
  return state <= FDCG_VERTEX && (state == FDCG_FREE || feature < count[state]);
}

uint32_t node_at(const fdcg_graph& graph, uint32_t state, uint32_t feature) {
  if (state == FDCG_FACE) return feature;
  if (state == FDCG_VERTEX) {
    uint32_t entry = 0;
    fdcg_get_fan(&graph, feature, &entry, 1);
    feature = entry >> 1;
  }
  return fdcg_get_connection(&graph, feature).node[0];
}

QueryPoint place_of(const fdcg_graph& graph, uint32_t corner) {
  return vec(fdcg_get_corner(&graph, corner).point);
}

double not_below_0(double value) {
  return value > 0 ? value : 0;
}

void set_weights(double a, double b, double c, fdcg_contact_info* info) {
  const double sum = a + b + c;
  info->weights[0] = sum > 0 ? a / sum : 1;
  info->weights[1] = sum > 0 ? b / sum : 0;
  info->weights[2] = sum > 0 ? c / sum : 0;
}

// Of the fan of triangles from the face's first corner that in which the place lies deepest.
void weigh_on_face(const fdcg_graph& graph, uint32_t node, QueryPoint at, fdcg_contact_info* info) {
  const fdcg_node_info face = fdcg_get_node(&graph, node);
  const QueryPoint normal = vec(face.normal);
  const uint32_t hub = fdcg_get_side(&graph, node, 0).corner;
  uint32_t last = fdcg_get_side(&graph, node, 1).corner;
  double deepest = -HUGE_VAL;
  for (uint32_t k = 2; k < face.side_count; ++k) {
    const uint32_t next = fdcg_get_side(&graph, node, k).corner;
    const QueryPoint a = place_of(graph, hub), b = place_of(graph, last), c = place_of(graph, next);
    const double of_a = dot(cross(b - at, c - at), normal), of_b = dot(cross(c - at, a - at), normal),
                 of_c = dot(cross(a - at, b - at), normal);
    const double whole = of_a + of_b + of_c, depth = smaller(smaller(of_a, of_b), of_c) / (whole > 0 ? whole : 1);
    if (depth > deepest) {
      deepest = depth;
      info->corners[0] = hub, info->corners[1] = last, info->corners[2] = next;
      set_weights(not_below_0(of_a), not_below_0(of_b), not_below_0(of_c), info);
    }
    last = next;
  }
}

void weigh(const fdcg_graph& graph, const fdcg_result& now, fdcg_contact_info* info) {
  info->corners[0] = info->corners[1] = info->corners[2] = FDCG_NONE;
  if (now.state == FDCG_VERTEX) {
    info->corners[0] = now.feature;
    info->weights[0] = 1;
    return;
  }
  const fdcg_header& header = *graph.header;
  const QueryPoint at = vec(now.god_object_m) * (1 / header.metres_per_unit) - vec(header.origin);
  if (now.state == FDCG_FACE) return weigh_on_face(graph, now.feature, at, info);
  const fdcg_connection_info edge = fdcg_get_connection(&graph, now.feature);
  const double way = dot(at - place_of(graph, edge.corner[0]), vec(edge.direction));
  const double along = smaller(not_below_0(way), edge.length);
  info->corners[0] = edge.corner[0];
  info->corners[1] = edge.corner[1];
  set_weights(edge.length - along, along, 0, info);
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_contact_info_init(fdcg_contact_info* info, uint32_t struct_bytes) {
  fdcg::fill_defaults(info, fdcg_contact_info{}, struct_bytes);
}

extern "C" uint32_t fdcg_get_contact_events(const fdcg_result* before, const fdcg_result* now) {
  if (now == nullptr) return 0;
  const bool touched = before != nullptr && before->state != FDCG_FREE, touches = now->state != FDCG_FREE;
  const bool slipped = touched && before->slipping != 0, slips = touches && now->slipping != 0;
  uint32_t events = 0;
  if (touches && !touched) events |= FDCG_EVENT_BEGAN;
  if (touched && !touches) events |= FDCG_EVENT_ENDED;
  if (slips && !slipped) events |= FDCG_EVENT_SLIP_BEGAN;
  if (slipped && !slips) events |= FDCG_EVENT_SLIP_ENDED;
  if (touched && touches && (before->state != now->state || before->feature != now->feature)) events |= FDCG_EVENT_FEATURE;
  return events;
}

extern "C" fdcg_status fdcg_get_contact_info(const fdcg_graph* graph, const uint32_t* source_of_node, const fdcg_result* before,
                                             const fdcg_result* now, double tick_s, fdcg_contact_info* info,
                                             fdcg_error* error) {
  using namespace fdcg;
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not open");
  if (now == nullptr || info == nullptr) return refuse(error, "now or info: null pointer");
  if (const fdcg_status status =
          check_struct_bytes(info->struct_bytes, sizeof *info, "info", "; start from fdcg_make_contact_info()", error);
      status != FDCG_OK) {
    return status;
  }
  if (!(tick_s > 0 && tick_s <= 1e9)) return refuse(error, "tick_s", tick_s, 0, 1e9);
  if (!is_of(*graph->header, now->state, now->feature)) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("now: state ", now->state, ", feature ", now->feature, " is not of this graph; give the graph that was stepped");
  }
  fdcg_contact_info full = {};
  full.node = full.source_face = full.material = FDCG_NONE;
  full.corners[0] = full.corners[1] = full.corners[2] = FDCG_NONE;
  full.events = fdcg_get_contact_events(before, now);
  if (now->state != FDCG_FREE) {
    full.node = node_at(*graph, now->state, now->feature);
    full.material = fdcg_get_node_material(graph, full.node);
    if (source_of_node != nullptr) full.source_face = source_of_node[full.node];
    store(normal_at(*graph, now->state, now->feature), full.normal);
    weigh(*graph, *now, &full);
    if (before != nullptr && before->state != FDCG_FREE && now->slipping != 0)
      store((vec(now->god_object_m) - vec(before->god_object_m)) * (1 / tick_s), full.slip_m_per_s);
  }
  fill_defaults(info, full, info->struct_bytes);
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_invert_source_map(const fdcg_graph* graph, uint32_t* source_of_node, uint32_t count,
                                              fdcg_error* error) {
  using namespace fdcg;
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not open");
  if (source_of_node == nullptr) return refuse(error, "source_of_node: null pointer");
  if (graph->source_map == nullptr)
    return refuse(error, FDCG_E_ABSENT, "the file has no source map; compile the mesh without --without source-map");
  const uint32_t nodes = graph->header->node_count;
  if (count < nodes) return Message(error, FDCG_E_ARGUMENT).say("count is ", count, ", the graph has ", nodes, " nodes");
  for (uint32_t n = 0; n < nodes; ++n)
    source_of_node[n] = FDCG_NONE;
  for (uint32_t f = graph->header->source_face_count; f-- > 0;) {
    if (graph->source_map[f] < nodes) source_of_node[graph->source_map[f]] = f;
  }
  return FDCG_OK;
}
