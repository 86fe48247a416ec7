// SPDX-License-Identifier: Apache-2.0
// A ball around a free contact that no node reaches into but a few, which are named (contact-model FREE-7): while the HIP stays
// in it and surely passes these, a tick's way is free of collisions and needs no sweep. The requested radius depends on the
// speed: a few ticks' way is worth its computation, more is not.
#pragma once

#include "graph/box_tree.hpp"
#include "graph/graph_view.hpp"
#include "graph/tolerances.hpp"
#include "step/contact_internals.hpp"
#include "step/fan_sweep.hpp"

namespace fdcg {

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
inline Real node_distance(const GraphView<Geometry>& graph, NodeRef<Geometry> node, Vec3<Real> at, Real nearest,
                          uint32_t* work_left) {
  const Real from_plane = absolute(distance_from(node, at));
  if (node.is_inexact()) return from_plane - static_cast<Real>(graph.max_deviation());
  if (!(from_plane < nearest)) return from_plane;
  if (!graph.has_planes()) spend(work_left, kDerivedSideWork * node.side_count());
  Real beside = 0;
  for (uint32_t k = 0; k < node.side_count() && beside < nearest; ++k) {
    const Real beyond = distance_beyond(node, k, at);
    if (beyond > beside) beside = beyond;
  }
  return beside > 0 ? root(from_plane * from_plane + beside * beside) : from_plane;
}

// Of two planes with one offset.
template <class Geometry>
[[gnu::noinline, gnu::cold]] bool have_one_normal(NodeRef<Geometry> a, NodeRef<Geometry> b) {
  const auto n = a.normal(), m = b.normal();
  return n.x == m.x && n.y == m.y && n.z == m.z;
}

// The nodes nearest to a place, as many as a clear ball may have, and how near the next one is. Of nodes of one plane, bit for
// bit, one stands for all: a way that surely passes it passes all of them.
template <class Geometry>
class NearestNodes {
  using Real = typename Geometry::Real;

 public:
  NearestNodes(const GraphView<Geometry>& graph, Real reach) : graph_(graph), limit_(reach) {}

  // What is no nearer counts no longer.
  [[nodiscard]] Real limit() const { return limit_; }
  void block(Real distance) { limit_ = distance < limit_ ? distance : limit_; }
  void add(uint32_t node, Real distance) {
    const NodeRef<Geometry> added = graph_.node(node);
    const Real offset = added.plane().offset;
    uint32_t at = 0;
    while (at < count_ && !(offset == offset_[at] && have_one_normal(added, graph_.node(node_[at]))))
      ++at;
    if (at < count_) {
      stands_for_several_ = true;
      if (!(distance < distance_[at])) return;
    } else if (count_ == kMostNear) {  // the farthest of all makes room
      at = 0;
      for (uint32_t i = 1; i < kMostNear; ++i)
        at = distance_[i] > distance_[at] ? i : at;
      block(distance < distance_[at] ? distance_[at] : distance);
      if (!(distance < distance_[at])) return;
    } else {
      ++count_;
    }
    node_[at] = node;
    offset_[at] = offset;
    distance_[at] = distance;
  }
  // Stores those that are nearer than `radius`.
  void store(Real radius, ClearBall* ball, NearNodes* near) const {
    uint16_t count = 0;
    *near = {};
    for (uint32_t i = 0; i < kMostNear; ++i) {  // not count_: with AVX-512 GCC 12 warns of what its masked loads never read
      if (i < count_ && distance_[i] < radius) near->node[count++] = node_[i];
    }
    ball->near_count = count;
    ball->lists_all = stands_for_several_ ? 0 : 1;
  }

 private:
  const GraphView<Geometry>& graph_;
  Real limit_;
  uint32_t count_ = 0;
  bool stands_for_several_ = false;
  uint32_t node_[kMostNear];
  Real offset_[kMostNear];  // of their planes
  Real distance_[kMostNear];
};

// Tells the list of a leaf's nodes; none is nearer than `least`. A busy corner is kept outside the ball: a way may meet the
// corner and none of its faces (contact-model FREE-8).
template <class Geometry, class Real = typename Geometry::Real>
inline void look_at_leaf(const GraphView<Geometry>& graph, uint32_t leaf, Vec3<Real> at, Real least,
                         NearestNodes<Geometry>* nearest, uint32_t* work_left) {
  const uint32_t first = leaf * FDCG_LEAF_NODES, end = first + FDCG_LEAF_NODES;
  uint32_t run = FDCG_NONE;
  for (uint32_t n = first; n < end && n < graph.header()->node_count; ++n) {
    const Real beside = node_distance(graph, graph.node(n), at, nearest->limit(), work_left),
               distance = beside > least ? beside : least;
    if (!(distance < nearest->limit())) continue;
    if constexpr (Geometry::kKeepsDirections) {
      run = fan_run_of(graph, n, run);
      if (run != FDCG_NONE) {
        const uint32_t corner = graph.busy_corners()[graph.fan_runs()[run].busy].corner;
        nearest->block(norm(graph.corner_point(corner) - at) - static_cast<Real>(graph.max_deviation()));
      }
      nearest->add(n, distance);
    } else {
      nearest->block(distance);
    }
  }
}

// Whether a way within a clear ball surely meets none of the nodes that reach into it.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] bool passes_near_nodes(const GraphView<Geometry>& graph, const ContactInternals& inner,
                                         const Vec3<Real>& from, const Vec3<Real>& to) {
  const Real to_bound = plane_rounding_bound(graph, to);
  const Real slab = slab_depth(2 * graph.max_deviation(), plane_rounding_bound(graph, from));
  for (uint32_t i = 0; i < inner.clear_ball.near_count; ++i) {
    if (!surely_passes(graph.node(inner.near.node[i]).plane(), from, to, to_bound, slab)) return false;
  }
  return true;
}

// The radius of a ball around `at` that no face reaches into but those of `near`, which the ball counts, by more than the
// rounding of a sweep inside it: such a sweep finds nothing else. 0 where it would be below `way`. Cost: at most
// kClearWork, where planes are stored 48 records and leaves; a handful where nothing is near.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::hot]] Real clear_radius(const GraphView<Geometry>& graph, const Vec3<Real>& at, Real way, NearNodes* near,
                                              ClearBall* ball) {
  constexpr Real kWaysAhead = 8;               // what a look is to pay for, in ways of this tick
  constexpr Real kLeastReach = Real(1) / 256;  // ... and tree units
  constexpr Real kFar = 64, kTreeReach = 16;   // tree units: no box reaches further than 8
  const Real unit = static_cast<Real>(tree_unit(graph.header()->extent)), per_unit = 1 / unit;
  const Vec3<Real> p = at * per_unit;
  const Real size = norm1(p);
  ball->near_count = 0;
  ball->lists_all = 1;
  if (size > kFar) return (size / 3 - kTreeReach) * kClearShare<Real> * unit;
  const Real margin = kClearMargins * tree_rounding<Real>(2 * size, 2 * size * RealLimits<Real>::kEpsilon);
  const Real length = way * per_unit;
  if (length > kFar) return 0;  // a jump
  const Real reach = kWaysAhead * length > kLeastReach ? kWaysAhead * length : kLeastReach;
  const float point[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  const float least = static_cast<float>(length + margin), too_near2 = least * least;
  constexpr float kOpened = 0.25F;  // what is not nearer than half the limit so far is not opened but taken as it is
  float limit2 = static_cast<float>(reach * reach), clear2 = limit2;
  NearestNodes<Geometry> nearest(graph, reach * unit);
  const BoxTree tree(graph.header()->node_count);
  WaitingBoxes waiting(tree);
  uint32_t work_left = kClearWork;
  while (!waiting.is_empty() && clear2 > too_near2) {
    const WaitingBoxes::Item next = waiting.pop();
    if (!(next.key < clear2)) continue;
    if (work_left == 0 || !(next.key < kOpened * limit2)) {
      clear2 = next.key;
      continue;
    }
    spend(&work_left, kClearVisitWork);
    if (next.level < 0) {
      look_at_leaf(graph, next.index, at, static_cast<Real>(root(next.key)) * unit, &nearest, &work_left);
      const float limit = static_cast<float>(nearest.limit() * per_unit);
      limit2 = limit * limit;
      clear2 = limit2 < clear2 ? limit2 : clear2;
      continue;
    }
    float distance2[FDCG_TREE_WAYS];
    const fdcg_box8& boxes = graph.hierarchy()[tree.first[next.level] + next.index];
    const uint32_t lanes = tree.lanes(next.level, next.index);
    uint32_t nearer = squared_distances(boxes, point, clear2, distance2) & lanes;
    if (graph.has_tightened(next.level, next.index, nearer)) nearer &= squared_distances(boxes, point, clear2, distance2);
    waiting.push(next, nearer, distance2);
  }
  const Real clear = static_cast<Real>(root(clear2)), radius = clear * kClearShare<Real> - margin;
  if (!(radius > length)) return 0;
  nearest.store(clear * unit, ball, near);
  return radius * unit;
}

}  // namespace fdcg
