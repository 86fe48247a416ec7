// SPDX-License-Identifier: Apache-2.0
// Whether a way that met nothing has come in all the same (contact-model FREE-9): only merged faces, whose corners lie off
// their planes, leave gaps that a way may pass.
#pragma once

#include "step/sweep.hpp"

namespace fdcg {

// Whether a place lies inside of a surface: a line from outside winds about it. Through loops of edges that neighbours share,
// and so through no gap, whatever their planes; these tell on which side of a loop the place is, but for the slab.
template <class Geometry>
class InsideTest : public Sweep<Geometry> {
  using Real = typename Geometry::Real;
  using Base = Sweep<Geometry>;
  using Base::from_, Base::graph_, Base::slab_, Base::times_wound_by, Base::to_, Base::touch, Base::way_, Base::work_left_;

 public:
  InsideTest(const GraphView<Geometry>& graph, const Vec3<Real>& outside, const Vec3<Real>& x, uint32_t* work_left)
      : Base(graph, outside, outside, x, kFree, work_left) {}

  // False too where the place is so near to the surface that it cannot be told, and where the work runs out.
  [[nodiscard]] bool holds() {
    int times = 0;
    return (graph_.hierarchy() != nullptr ? search(&times) : count_from(0, graph_.header()->node_count, &times)) && times > 0;
  }

 private:
  // How often the line comes in before the place, less how often it goes out. False: it cannot be told.
  [[nodiscard]] bool search(int* times) {
    if (!Base::enter_tree()) return false;
    const BoxTree tree(graph_.header()->node_count);
    WaitingBoxes waiting(tree);
    while (!waiting.is_empty()) {
      const WaitingBoxes::Item next = waiting.pop();
      if (next.level < 0) {
        if (!count_from(next.index * FDCG_LEAF_NODES, FDCG_LEAF_NODES, times)) return false;
        continue;
      }
      float entry[FDCG_TREE_WAYS];
      const uint32_t touched = touch(tree, next.level, next.index, entry);
      waiting.push(next, touched, entry);
    }
    return true;
  }
  [[nodiscard]] bool count_from(uint32_t first, uint32_t nodes, int* times) const {
    for (uint32_t n = first; n < first + nodes && n < graph_.header()->node_count; ++n) {
      if (*work_left_ == 0 || !count(graph_.node(n), times)) return false;
    }
    return true;
  }
  [[nodiscard]] bool count(NodeRef<Geometry> node, int* times) const {
    spend(work_left_, kGlanceWork);
    const Real begin = distance_from(node, from_), end = distance_from(node, to_);
    if ((begin > slab_ && end > slab_) || (begin < -slab_ && end < -slab_)) return true;
    if (Base::lies_surely(node) == Base::Lies::beside) return true;
    const int wound = times_wound_by(node);
    if (wound == 0) return true;
    bool is_met = (wound > 0) == (end < 0);
    if (absolute(end) <= slab_ && !lies_apart(node, &is_met)) return false;
    if (is_met) *times += wound;
    return true;
  }

  // Of a node near whose plane the place is: whether all of it lies before the place along the line, and so is met, or beyond.
  [[nodiscard]] bool lies_apart(NodeRef<Geometry> node, bool* is_met) const {
    uint32_t before = 0;
    for (uint32_t k = 0; k < node.side_count(); ++k)
      before += dot(graph_.corner_point(node.corner(k)) - to_, way_) < 0;
    *is_met = before != 0;
    return before == 0 || before == node.side_count();
  }
};

template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool is_in_bounds(const GraphView<Geometry>& graph, const Vec3<Real>& x) {
  const fdcg_header& header = *graph.header();
  const double at[3] = {x.x, x.y, x.z};
  for (int k = 0; k < 3; ++k) {
    if (!(at[k] > header.bounds_min[k] && at[k] < header.bounds_max[k])) return false;
  }
  return true;
}
// From a place in the bounds through their nearest side, aslant: edges of meshes are mostly not.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Vec3<Real> out_of_bounds(const GraphView<Geometry>& graph, const Vec3<Real>& x) {
  const fdcg_header& header = *graph.header();
  Real at[3] = {x.x, x.y, x.z};
  Real nearest = RealLimits<Real>::kFar, sign = 1;
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    const Real low = at[k] - Real(header.bounds_min[k]), high = Real(header.bounds_max[k]) - at[k];
    const Real off = low < high ? low : high;
    if (off < nearest) nearest = off, axis = k, sign = low < high ? Real(-1) : Real(1);
  }
  constexpr Real kAslant[3] = {Real(0.8125), Real(0.4375), Real(0.3125)};
  const Real way = (nearest + Real(header.extent) / 8) / kAslant[0] * sign;
  for (int k = 0; k < 3; ++k)
    at[(axis + k) % 3] += way * kAslant[k];
  return {at[0], at[1], at[2]};
}

// Of a place beside the surface one in front of it, clear of all slabs: of the node, or of both at the edge.
template <class Geometry, class Real = typename Geometry::Real>
[[nodiscard]] inline Vec3<Real> in_front_of(const GraphView<Geometry>& graph, const FirstHit<Real>& missed,
                                            const Vec3<Real>& x) {
  Vec3<Real> outward = graph.node(missed.node).normal();
  if (missed.feature.state == FDCG_EDGE) {
    const ConnectionRef<Geometry> connection = graph.connection(missed.feature.index);
    const uint32_t other = connection.node(connection.node(0) == missed.node ? 1 : 0);
    if (other != FDCG_NONE) outward = outward + graph.node(other).normal();
  }
  return x + outward * (2 * slab_depth(2 * graph.max_deviation(), plane_rounding_bound(graph, x)));
}

// Whether a way that may have missed a node, from `from`, has come in before `x`. An open surface has no inside: there the line
// comes from the way's beginning, in front of what it may have missed; of a closed one neither is asked.
template <class Geometry, class Real = typename Geometry::Real>
[[nodiscard, gnu::noinline, gnu::cold]] bool has_come_in(const GraphView<Geometry>& graph, const FirstHit<Real>* missed,
                                                         const Vec3<Real>& from, const Vec3<Real>& x, uint32_t* work_left) {
  if (!is_in_bounds(graph, x)) return false;
  const bool is_closed = graph.header()->connection_type_count[FDCG_BOUNDARY] == 0;
  const Vec3<Real> outside = is_closed ? out_of_bounds(graph, x) : in_front_of(graph, *missed, from);
  return InsideTest<Geometry>(graph, outside, x, work_left).holds();
}

// What a way that met nothing has come in by, to end inside or to go out again; kFree where that is nothing.
template <class Geometry, class Real = typename Geometry::Real>
[[nodiscard, gnu::noinline, gnu::cold]] FirstHit<Real> missed_by(const Sweep<Geometry>& sweep, const GraphView<Geometry>& graph,
                                                                 const Vec3<Real>& to, uint32_t* work_left) {
  const FirstHit<Real>& missed = sweep.missed();
  if (missed.node == FDCG_NONE) return {};
  const Vec3<Real> from = sweep.point_at(0);
  if (has_come_in(graph, &missed, from, to, work_left)) return missed;
  // The other way round it comes in where it went out.
  Sweep<Geometry> back(graph, to, to, from, kFree, work_left);
  FirstHit<Real> out;
  uint32_t next_leaf = 0;
  if (!(graph.hierarchy() != nullptr ? back.run(&out) : back.run_in_order(&out, &next_leaf))) return {};
  if (out.feature.is_free()) out = back.missed();
  const Real end = out.node != FDCG_NONE ? 1 - out.fraction : Real(1), inside = end - missed.fraction;
  if (!(inside > 0)) return {};
  constexpr Real kShares[] = {0.5, 0.75, 0.25};
  for (const Real share : kShares) {
    if (has_come_in(graph, &missed, from, sweep.point_at(missed.fraction + inside * share), work_left)) return missed;
  }
  return {};
}

}  // namespace fdcg
