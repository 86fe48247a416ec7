// SPDX-License-Identifier: Apache-2.0
// The god-object on a vertex (contact-model section 7; replaces Melder 2004, 5g and the vertex rules of its section 7).
#pragma once

#include "edge.hpp"
#include "implicit_tree.hpp"
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

// Looks at every edge of the corner.
template <class Real>
inline Steepest<Real> steepest_of_all(const GraphView<Real>& graph, const typename Records<Real>::Corner& corner,
                                      Vec3<Real> t) {
  Steepest<Real> best;
  for (uint32_t i = 0; i < corner.fan_count; ++i)
    consider_fan_entry(graph, graph.fans[corner.first_fan + i], t, best);
  return best;
}

// Boxes of a busy corner's tree that one search may open; what it has found by then is taken. Some 20 suffice on a cone of
// 10,000 sides; only fans made to defeat the boxes come near.
inline constexpr int kMaxFanVisits = 256;

// Branch and bound over a busy corner's tree: a box whose best direction reaches no further than what is found, but for
// rounding, is left out.
template <class Real>
inline Steepest<Real> steepest_by_tree(const GraphView<Real>& graph, const typename Records<Real>::Corner& corner,
                                       Vec3<Real> t) {
  struct Waiting {
    Real bound;
    uint32_t box;  // within its level
    int level;
  };
  const ImplicitTree layout(corner.fan_count, FDCG_LEAF_FAN);
  const auto* boxes = graph.fan_boxes + ((corner.flags >> FDCG_CORNER_TREE_SHIFT) - 1);
  const Real rounding = 16 * RealLimits<Real>::kEpsilon * norm1(t);
  const auto bound_of = [&](int level, uint32_t i) {
    const auto& box = boxes[layout.first[level] + i];
    Real bound = dot(vec(box.centre), t) - rounding;
    for (const auto& axis : box.axis)
      bound += absolute(dot(vec(axis), t));
    return bound;
  };
  Steepest<Real> best;
  Waiting stack[kMaxLevels + 2];
  int waiting = 0;
  stack[waiting++] = {bound_of(layout.levels - 1, 0), 0, layout.levels - 1};
  for (int visits = 0; waiting > 0 && visits < kMaxFanVisits; ++visits) {
    const Waiting next = stack[--waiting];
    if (!(next.bound > best.reach)) continue;
    if (next.level == 0) {
      const uint32_t first = next.box * FDCG_LEAF_FAN;
      const uint32_t count = corner.fan_count - first < FDCG_LEAF_FAN ? corner.fan_count - first : FDCG_LEAF_FAN;
      for (uint32_t i = first; i < first + count; ++i)
        consider_fan_entry(graph, graph.fans[corner.first_fan + i], t, best);
      continue;
    }
    const int level = next.level - 1;
    const uint32_t child = next.box * 2;
    const bool has_two = child + 1 < layout.size[level];
    const Waiting first = {bound_of(level, child), child, level};
    const Waiting second = {has_two ? bound_of(level, child + 1) : Real(0), child + 1, level};
    const bool second_is_better = has_two && second.bound > first.bound;
    if (second_is_better) {
      stack[waiting++] = first;
      stack[waiting++] = second;
    } else {
      if (has_two) stack[waiting++] = second;
      stack[waiting++] = first;
    }
  }
  return best;
}

// Cost: one connection, one node and two Voronoi planes for each edge of the corner; at a busy corner for some eight of them,
// and the logarithm of their number in boxes.
template <class Real>
inline Decision corner_rule(Walk<Real>& walk) {
  const auto& corner = walk.graph.corners[walk.active.index];
  const Vec3<Real> t = walk.hip - vec(corner.point);
  const bool is_busy = corner.flags >> FDCG_CORNER_TREE_SHIFT != 0;
  const Steepest<Real> best = is_busy ? steepest_by_tree(walk.graph, corner, t) : steepest_of_all(walk.graph, corner, t);
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
