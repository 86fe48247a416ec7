// SPDX-License-Identifier: Apache-2.0
// The god-object on a vertex (contact-model section 7; replaces Melder 2004, 5g and the vertex rules of its section 7).
#pragma once

#include "edge.hpp"
#include "walk.hpp"

namespace fdcg {

// The steepest descent from a corner: the face, edge or (where neither climbs) apex along which t = HIP - v reaches furthest.
template <class Real>
struct Steepest {
  Feature feature = kFree;  // kFree stands for the apex
  Real reach = 0;
};

// One entry of the fan: its edge, and the face to the left of it.
template <class Real>
inline void consider_fan_entry(const GraphView<Real>& graph, uint32_t entry, Vec3<Real> t, Steepest<Real>& best) {
  const uint32_t index = entry >> 1, end = entry & 1;
  const auto& connection = graph.connections[index];
  const Real along = end == 0 ? dot(t, vec(connection.edge)) : -dot(t, vec(connection.edge));
  if (along > best.reach) best = {{FDCG_EDGE, index}, along};
  if (connection.node[end] == FDCG_NONE) return;
  const auto& node = graph.nodes[connection.node[end]];
  const uint32_t outgoing = connection.side[end];
  const uint32_t incoming = (outgoing == 0 ? node.side_count : outgoing) - 1u;
  if (!(dot(graph.voronoi_plane(node, outgoing).normal, t) < 0)) return;
  if (!(dot(graph.voronoi_plane(node, incoming).normal, t) < 0)) return;
  const Vec3<Real> normal = vec(node.plane.normal);
  const Real reach = norm(t - normal * dot(normal, t));
  if (reach > best.reach) best = {{FDCG_FACE, connection.node[end]}, reach};
}

// Cost: one connection, one node and two Voronoi planes for each edge of the corner.
template <class Real>
inline Decision corner_rule(Walk<Real>& walk) {
  const auto& corner = walk.graph.corners[walk.active.index];
  const Vec3<Real> t = walk.hip - vec(corner.point);
  Steepest<Real> best;
  for (uint32_t i = 0; i < corner.fan_count; ++i) {
    consider_fan_entry(walk.graph, walk.graph.fans[corner.first_fan + i], t, best);
  }
  if (best.feature.state == FDCG_FACE) {
    return go_to(walk.side(walk.graph.nodes[best.feature.index]) < 0 ? best.feature : kFree);
  }
  if (best.feature.state == FDCG_EDGE) {
    const auto& connection = walk.graph.connections[best.feature.index];
    const EdgeSides<Real> s = edge_sides(walk, connection);
    if (connection.type == FDCG_BOUNDARY) {
      return go_to(s.side[0] < 0 && s.voronoi[0] < 0 ? Feature{FDCG_FACE, connection.node[0]} : kFree);
    }
    return go_to(s.side[0] + s.side[1] < 0 ? best.feature : kFree);
  }
  if ((corner.flags & FDCG_CORNER_OPEN) != 0) return go_to(kFree);
  const Vec3<Real> normal = {Real(corner.normal[0]), Real(corner.normal[1]), Real(corner.normal[2])};
  return dot(t, normal) < 0 ? rest() : go_to(kFree);
}

}  // namespace fdcg
