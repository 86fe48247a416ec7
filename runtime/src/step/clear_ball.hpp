// SPDX-License-Identifier: Apache-2.0
// A ball around a free contact that no face touches (contact-model FREE-7): while the HIP stays in it, a tick's way is free of
// collisions and needs no sweep. The requested radius depends on the speed: a few ticks' way is worth its computation, more is
// not.
#pragma once

#include "graph/box_tree.hpp"
#include "graph/graph_view.hpp"
#include "graph/tolerances.hpp"
#include "step/contact_internals.hpp"

namespace fdcg {

// Records and leaves that one look may open: what has been proved clear by then is taken.
inline constexpr int kMostClearVisits = 24;

// `hip`: in double whatever the graph's reals, which is at hand sooner. Rounding it to them moves it by far less than
// clear_radius leaves as a margin.
inline bool is_in_clear_ball(const ClearBall& ball, Vec3<double> hip) {
  const Vec3<double> gap = hip - vec(ball.centre);
  return dot(gap, gap) < ball.radius2;  // false where there is none
}

// How near a node may be; exact up to rounding error where its nearest point is on its inside or on a side. Not asked to be
// nearer than `nearest`: only what may be is worth its sides. A node whose corners lie off its plane is as near as that slab: a
// way may enter it from beside.
template <class Geometry, class Real = typename Geometry::Real>
inline Real node_distance(const GraphView<Geometry>& graph, NodeRef<Geometry> node, Vec3<Real> at, Real nearest) {
  const Real from_plane = absolute(node.plane().distance(at));
  if (node.is_inexact()) return from_plane - static_cast<Real>(graph.max_deviation());
  if (!(from_plane < nearest)) return from_plane;
  Real beside = 0;
  for (uint32_t k = 0; k < node.side_count(); ++k) {
    const Real beyond = node.voronoi_plane(k).distance(at);
    if (beyond > beside) beside = beyond;
  }
  return beside > 0 ? root(from_plane * from_plane + beside * beside) : from_plane;
}

// How near a leaf's nodes may be, squared, in tree units. `reach`: farther does not matter.
template <class Geometry, class Real = typename Geometry::Real>
inline float squared_leaf_distance(const GraphView<Geometry>& graph, uint32_t leaf, Vec3<Real> at, Real reach, Real per_unit) {
  const uint32_t first = leaf * FDCG_LEAF_NODES, end = first + FDCG_LEAF_NODES;
  Real nearest = reach;
  for (uint32_t n = first; n < end && n < graph.header()->node_count; ++n) {
    const Real distance = node_distance(graph, graph.node(n), at, nearest);
    if (distance < nearest) nearest = distance > 0 ? distance : Real(0);
  }
  const float distance = static_cast<float>(nearest * per_unit);
  return distance * distance;
}

// Which of a record's boxes are nearer than that, a bit each.
inline uint32_t nearer_boxes(const fdcg_box8& boxes, const float (&point)[3], float clear2,
                             float (&distance2)[FDCG_TREE_WAYS]) {
  squared_distances(boxes, point, distance2);
  uint32_t near = 0;
  for (uint32_t j = 0; j < FDCG_TREE_WAYS; ++j)
    near |= uint32_t{distance2[j] < clear2} << j;
  return near;
}

// The radius of a ball around `at` that no face reaches into, by more than the rounding of a sweep inside it: such a sweep
// finds nothing. 0 where it would be below `way`. Cost: at most kMostClearVisits records and leaves, a handful where nothing is
// near.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Real clear_radius(const GraphView<Geometry>& graph, Vec3<Real> at, Real way) {
  constexpr Real kWaysAhead = 12;              // what a look is to pay for, in ways of this tick
  constexpr Real kLeastReach = Real(1) / 256;  // ... and tree units
  constexpr Real kFar = 64, kTreeReach = 16;   // tree units: no box reaches further than 8
  const Real unit = static_cast<Real>(tree_unit(graph.header()->extent)), per_unit = 1 / unit;
  const Vec3<Real> p = at * per_unit;
  const Real size = norm1(p);
  if (size > kFar) return (size / 3 - kTreeReach) * kClearShare<Real> * unit;
  const Real margin = kClearMargins * tree_rounding<Real>(2 * size, 2 * size * RealLimits<Real>::kEpsilon);
  const Real length = way * per_unit;
  if (length > kFar) return 0;  // a jump
  const Real reach = kWaysAhead * length > kLeastReach ? kWaysAhead * length : kLeastReach;
  const float point[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  const float least = static_cast<float>(length + margin), too_near2 = least * least;
  constexpr float kOpened = 0.25F;  // what is not nearer than half the nearest node so far is not opened but taken as it is
  float node2 = static_cast<float>(reach * reach), clear2 = node2;
  const BoxTree tree(graph.header()->node_count);
  WaitingBoxes waiting(tree);
  for (int visits = 0; !waiting.is_empty() && clear2 > too_near2;) {
    const WaitingBoxes::Item next = waiting.pop();
    if (!(next.key < clear2)) continue;
    if (visits == kMostClearVisits || !(next.key < kOpened * node2)) {
      clear2 = next.key;
      continue;
    }
    ++visits;
    if (next.level < 0) {
      const float distance2 = squared_leaf_distance(graph, next.index, at, reach * unit, per_unit);
      const float nearest2 = distance2 > next.key ? distance2 : next.key;
      if (nearest2 < node2) node2 = nearest2;
      if (nearest2 < clear2) clear2 = nearest2;
      continue;
    }
    float distance2[FDCG_TREE_WAYS];
    const fdcg_box8& boxes = graph.hierarchy()[tree.first[next.level] + next.index];
    const uint32_t lanes = tree.lanes(next.level, next.index);
    uint32_t near = nearer_boxes(boxes, point, clear2, distance2) & lanes;
    if (graph.has_tightened(next.level, next.index, near)) near = nearer_boxes(boxes, point, clear2, distance2) & lanes;
    waiting.push(next, near, distance2);
  }
  const Real radius = static_cast<Real>(root(clear2)) * kClearShare<Real> - margin;
  return radius > length ? radius * unit : Real(0);
}

}  // namespace fdcg
