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
inline void consider_fan_entry(const GraphView<Real>& graph, const FanEntry& entry, Vec3<Real> t, Steepest<Real>& best) {
  const Real forward = dot(t, graph.edge(entry.connection).direction);
  const Real along = entry.end == 0 ? forward : -forward;
  if (along > best.reach) best = {{FDCG_EDGE, entry.connection}, along};
  if (entry.node == FDCG_NONE) return;
  const NodeRef<Real> node = graph.node(entry.node);
  if (!(dot(node.voronoi_plane(entry.outgoing).normal, t) < 0)) return;
  if (!(dot(node.voronoi_plane(node.previous(entry.outgoing)).normal, t) < 0)) return;
  const Vec3<Real> normal = node.normal();
  const Real reach = norm(t - normal * dot(normal, t));
  if (reach > best.reach) best = {{FDCG_FACE, entry.node}, reach};
}

// Looks at every edge of the corner.
template <class Real>
inline Steepest<Real> steepest_of_all(const GraphView<Real>& graph, CornerRef<Real> corner, Vec3<Real> t) {
  Steepest<Real> best;
  graph.for_each_in_fan(corner, [&](const FanEntry& entry) { consider_fan_entry(graph, entry, t, best); });
  return best;
}

// Boxes of a busy corner's tree that one search may open; what it has found by then is taken. Some 20 suffice on a cone of
// 10,000 sides; only fans made to defeat the boxes come near.
inline constexpr int kMaxFanVisits = 256;

// Branch and bound over a busy corner's tree: a box whose best direction reaches no further than what is found, but for
// rounding, is left out.
template <class Real>
inline Steepest<Real> steepest_by_tree(const GraphView<Real>& graph, CornerRef<Real> corner, Vec3<Real> t) {
  struct Waiting {
    Real bound;
    uint32_t box;  // within its level
    int level;
  };
  const ImplicitTree layout(corner.fan_count(), FDCG_LEAF_FAN);
  const auto* boxes = graph.fan_boxes + corner.busy().first_box;
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
      const uint32_t count = corner.fan_count() - first < FDCG_LEAF_FAN ? corner.fan_count() - first : FDCG_LEAF_FAN;
      for (uint32_t i = first; i < first + count; ++i)
        consider_fan_entry(graph, graph.fan_entry(corner, i), t, best);
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
  const CornerRef<Real> corner = walk.graph.corner(walk.active.index);
  const Vec3<Real> t = walk.hip - corner.point();
  const bool has_tree = corner.is_busy() && corner.busy().first_box != FDCG_NONE;
  const Steepest<Real> best = has_tree ? steepest_by_tree(walk.graph, corner, t) : steepest_of_all(walk.graph, corner, t);
  if (best.feature.state == FDCG_FACE) {
    return go_to(walk.side(walk.graph.node(best.feature.index)) < 0 ? best.feature : kFree);
  }
  if (best.feature.state == FDCG_EDGE) {
    const ConnectionRef<Real> connection = walk.graph.connection(best.feature.index);
    const EdgeSides<Real> s = edge_sides(walk, connection);
    if (connection.type() == FDCG_BOUNDARY) {
      return go_to(s.side[0] < 0 && s.voronoi[0] < 0 ? Feature{FDCG_FACE, connection.node(0)} : kFree);
    }
    return go_to(s.side[0] + s.side[1] < 0 ? best.feature : kFree);
  }
  if (corner.is_open()) return go_to(kFree);
  return dot(t, corner.normal()) < 0 ? rest() : go_to(kFree);
}

}  // namespace fdcg
