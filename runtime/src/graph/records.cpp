// SPDX-License-Identifier: Apache-2.0
// The functions that read a graph's records: widened to double, derived where the file leaves them out.
#include "base/config.hpp"
#include "graph/graph_view.hpp"

namespace fdcg {
namespace {

template <class Real>
fdcg_node_info node_info(const RigidView<Real>& graph, uint32_t index) {
  const auto node = graph.node(index);
  fdcg_node_info info = {};
  store(node.normal(), info.normal);
  info.offset = node.plane().offset;
  info.side_count = node.side_count();
  info.flags = node.flags();
  return info;
}

template <class Real>
fdcg_side_info side_info(const RigidView<Real>& graph, uint32_t node_index, uint32_t k) {
  const auto node = graph.node(node_index);
  const Plane<Real> plane = node.voronoi_plane(k);
  fdcg_side_info info = {};
  store(plane.normal, info.voronoi_normal);
  info.voronoi_offset = plane.offset;
  info.connection = node.connection(k);
  info.which = node.which(k);
  info.corner = node.corner(k);
  info.across = node.across(k);
  return info;
}

template <class Real>
fdcg_connection_info connection_info(const RigidView<Real>& graph, uint32_t index) {
  const auto connection = graph.connection(index);
  const Edge<Real> edge = graph.edge(index);
  fdcg_connection_info info = {};
  store(edge.direction, info.direction);
  info.length = edge.length;
  for (uint32_t k = 0; k < 2; ++k) {
    info.corner[k] = connection.corner(k);
    info.node[k] = connection.node(k);
    info.side[k] = connection.side(k);
  }
  info.type = connection.type();
  info.flatness = graph.connections()[index].flatness;
  return info;
}

template <class Real>
fdcg_corner_info corner_info(const RigidView<Real>& graph, uint32_t index) {
  const auto corner = graph.corner(index);
  fdcg_corner_info info = {};
  store(corner.point(), info.point);
  store(corner.normal(), info.normal);
  info.fan_count = corner.fan_count();
  info.is_open = corner.is_open() ? 1 : 0;
  return info;
}

template <class Real>
uint32_t fan(const RigidView<Real>& graph, uint32_t index, uint32_t* entries, uint32_t capacity) {
  uint32_t count = 0;
  graph.for_each_in_fan(graph.corner(index), [&](const FanEntry& entry) {
    if (count < capacity) entries[count] = entry.connection << 1 | entry.end;
    ++count;
  });
  return count;
}

// Calls `read` with the graph's typed view.
template <class Read>
auto with_view(const fdcg_graph* graph, Read read) {
  return with_real_of(*graph->header, [&](auto real) { return read(RigidView<decltype(real)>(*graph)); });
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_node_info fdcg_get_node(const fdcg_graph* graph, uint32_t node) {
  return fdcg::with_view(graph, [&](const auto& view) { return fdcg::node_info(view, node); });
}

extern "C" fdcg_side_info fdcg_get_side(const fdcg_graph* graph, uint32_t node, uint32_t side) {
  return fdcg::with_view(graph, [&](const auto& view) { return fdcg::side_info(view, node, side); });
}

extern "C" fdcg_connection_info fdcg_get_connection(const fdcg_graph* graph, uint32_t connection) {
  return fdcg::with_view(graph, [&](const auto& view) { return fdcg::connection_info(view, connection); });
}

extern "C" fdcg_corner_info fdcg_get_corner(const fdcg_graph* graph, uint32_t corner) {
  return fdcg::with_view(graph, [&](const auto& view) { return fdcg::corner_info(view, corner); });
}

extern "C" uint32_t fdcg_get_fan(const fdcg_graph* graph, uint32_t corner, uint32_t* entries, uint32_t capacity) {
  return fdcg::with_view(graph, [&](const auto& view) { return fdcg::fan(view, corner, entries, capacity); });
}
