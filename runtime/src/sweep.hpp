// SPDX-License-Identifier: Apache-2.0
// The free-space sweep (contact-model section 4): what a straight move from one point to another meets first.
#pragma once

#include "implicit_tree.hpp"
#include "walk.hpp"

namespace fdcg {

// Boxes that one sweep may open before it stops and leaves the rest of the way to the next tick. A way across a whole scan
// opens some hundreds; only where thousands of faces meet in one corner, and so all their boxes, come more together.
#ifndef FDCG_MAX_SWEEP_VISITS
#define FDCG_MAX_SWEEP_VISITS 16384
#endif
inline constexpr int kMaxSweepVisits = FDCG_MAX_SWEEP_VISITS;

template <class Real>
struct SweepResult {
  enum class Kind { clear, hit, bounded } kind = Kind::clear;
  Feature feature = kFree;  // hit: a node, or the connection or corner that the move meets exactly
  Vec3<Real> point = {};    // hit: on that feature; bounded: how far the way is known to be free
};

// Sweeps walk.god_object -> walk.hip, leaving out the faces that meet at `left`, on which the move starts.
// Watertight: a node is entered where the line passes its edges on the inner side, by exact signs that two neighbours share.
template <class Real>
class Sweep {
 public:
  Sweep(const Walk<Real>& walk, Feature left)
      : walk_(walk),
        graph_(walk.graph),
        from_(walk.god_object),
        to_(walk.hip),
        way_(to_ - from_),
        from_bound_(plane_rounding_bound(graph_, from_)),
        left_(left) {
    const double extent = graph_.header->extent;
    pad_ = 8 * RealLimits<Real>::kEpsilon * (Real(extent) + norm1(from_) + norm1(to_));
    const Real from[3] = {from_.x, from_.y, from_.z}, way[3] = {way_.x, way_.y, way_.z};
    for (int k = 0; k < 3; ++k) {
      axes_[k] = {from[k] + pad_, from[k] - pad_, absolute(way[k]) <= pad_ ? Real(0) : 1 / way[k]};
    }
    slab_ = Real(graph_.header->max_deviation) * (1 + 4 * RealLimits<Real>::kEpsilon) + from_bound_;
  }

  SweepResult<Real> run() {
    if (from_.x == to_.x && from_.y == to_.y && from_.z == to_.z) return result();  // no way, no direction
    if (graph_.hierarchy == nullptr) {
      for (uint32_t n = 0; n < graph_.header->node_count; ++n)
        try_node(n);
      return result();
    }
    const ImplicitTree layout(graph_.header->node_count, FDCG_LEAF_NODES);
    const int root = layout.levels - 1;
    const Real entry = box_entry(graph_.hierarchy[0]);
    if (entry <= best_fraction_) push({entry, 0, root});
    for (int visits = 0; waiting_ > 0; ++visits) {
      if (visits == kMaxSweepVisits) return bounded();
      const Waiting next = stack_[--waiting_];
      if (next.entry > best_fraction_) continue;
      if (next.level == 0) {
        try_leaf(next.box);
      } else {
        push_children(layout, next);
      }
    }
    return result();
  }

 private:
  // A box still to be looked at, and the fraction of the way at which it begins.
  struct Waiting {
    Real entry;
    uint32_t box;  // within its level
    int level;
  };
  // One coordinate of the way: where it begins, moved apart so that boxes grow, and 1 / its length, or 0 if that is too short.
  struct Axis {
    Real low_from, high_from, per_way;
  };
  static constexpr Real kBeyond = 2;  // a fraction after the end of the way

  void push(const Waiting& waiting) { stack_[waiting_++] = waiting; }

  // Nearer child on top; one level more on the stack costs at most one entry.
  void push_children(const ImplicitTree& layout, const Waiting& parent) {
    const int level = parent.level - 1;
    const uint32_t first = parent.box * 2;
    const bool has_two = first + 1 < layout.size[level];
    const fdcg_box* boxes = graph_.hierarchy + layout.first[level] + first;
    const Real entry0 = box_entry(boxes[0]);
    const Real entry1 = has_two ? box_entry(boxes[1]) : kBeyond;
    const bool swap = entry1 < entry0;
    const Real far_entry = swap ? entry0 : entry1, near_entry = swap ? entry1 : entry0;
    if (far_entry <= best_fraction_) push({far_entry, swap ? first : first + 1, level});
    if (near_entry <= best_fraction_) push({near_entry, swap ? first + 1 : first, level});
  }

  // Where the way enters a box, as a fraction, never too late; kBeyond if it misses it. The box is grown by more than the
  // rounding of this test.
  [[nodiscard]] Real box_entry(const fdcg_box& box) const {
    Real entry = 0, exit = 1;
    for (int k = 0; k < 3; ++k) {
      const Axis& axis = axes_[k];
      const Real low = Real(box.min[k]) - axis.low_from, high = Real(box.max[k]) - axis.high_from;
      if (axis.per_way == 0) {  // too short a way along this axis to be trusted with a quotient
        if (low > pad_ || high < -pad_) return kBeyond;
        continue;
      }
      const Real to_low = low * axis.per_way, to_high = high * axis.per_way;
      const Real first = to_low < to_high ? to_low : to_high, last = to_low < to_high ? to_high : to_low;
      if (first > entry) entry = first;
      if (last < exit) exit = last;
    }
    return entry <= exit ? entry : kBeyond;
  }

  void try_leaf(uint32_t leaf) {
    const uint32_t first = leaf * FDCG_LEAF_NODES;
    const uint32_t left_in_graph = graph_.header->node_count - first;
    const uint32_t count = left_in_graph < FDCG_LEAF_NODES ? left_in_graph : FDCG_LEAF_NODES;
    for (uint32_t n = first; n < first + count; ++n)
      try_node(n);
  }

  // Entered from its front: begins in front of the plane, ends behind it, and passes inside the loop. A node whose corners lie
  // off its plane is a slab: a way that begins within it still begins in front.
  void try_node(uint32_t n) {
    const NodeRef<Real> node = graph_.node(n);
    const Real end_side = walk_.side(node);
    if (!(end_side < 0)) return;
    const Real start_side = side_of(graph_, node, from_, from_bound_);
    const bool is_inexact = node.is_inexact();
    if (start_side < (is_inexact ? -slab_ : Real(0))) return;
    const Real fraction = start_side > 0 ? start_side / (start_side - end_side) : Real(0);
    if (!(fraction < best_fraction_) || is_left_out(n, node)) return;
    uint32_t met_exactly = 0;
    if (!passes_inside(node, &met_exactly)) return;
    const Vec3<Real> point = from_ + way_ * fraction;
    best_ = met_exactly > 0 ? on_rim(node, point) : Target{{FDCG_FACE, n}, 0};
    best_fraction_ = fraction;
  }

  [[nodiscard]] bool is_left_out(uint32_t n, NodeRef<Real> node) const {
    if (left_.state == FDCG_FACE) return left_.index == n;
    if (left_.state == FDCG_EDGE) {
      const ConnectionRef<Real> connection = graph_.connection(left_.index);
      return connection.node(0) == n || connection.node(1) == n;
    }
    if (left_.state != FDCG_VERTEX) return false;
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if (node.corner(k) == left_.index) return true;
    }
    return false;
  }

  // The line meets a side's edge exactly where its orientation against the edge is 0.
  [[nodiscard]] int orientation_to_side(NodeRef<Real> node, uint32_t k) const {
    const Vec3<double> start = widen(graph_.corner_point(node.corner(k)));
    const Vec3<double> end = widen(graph_.corner_point(node.corner(node.next(k))));
    const bool is_forward = node.which(k) == 0;  // both neighbours ask the same question
    const int sign =
        is_forward ? orient3d_sign(widen(from_), widen(to_), start, end) : orient3d_sign(widen(from_), widen(to_), end, start);
    return is_forward ? sign : -sign;
  }

  bool passes_inside(NodeRef<Real> node, uint32_t* met_exactly) const {
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      const int sign = orientation_to_side(node, k);
      if (sign > 0) return false;
      if (sign == 0) ++*met_exactly;
    }
    return true;
  }

  // What the line met: a feature, and for a connection how far along it.
  struct Target {
    Feature feature;
    Real parameter;
  };

  // Which of the sides that the line meets exactly has the point on it: sides in one line all meet it, one holds it.
  Target on_rim(NodeRef<Real> node, Vec3<Real> point) const {
    Target nearest = {kFree, 0};
    Real nearest_outside = 0;
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if (orientation_to_side(node, k) != 0) continue;
      const EdgeLine<Real> line(graph_.edge(node, k));
      const Real u = line.parameter(point);
      const Real outside = u < 0 ? -u : (u > line.length ? u - line.length : Real(0));
      if (nearest.feature == kFree || outside < nearest_outside) {
        nearest = {{FDCG_EDGE, node.connection(k)}, u};
        nearest_outside = outside;
      }
    }
    return nearest;
  }

  [[nodiscard]] SweepResult<Real> result() const {
    SweepResult<Real> r;
    if (best_.feature == kFree) return r;
    r.kind = SweepResult<Real>::Kind::hit;
    r.feature = best_.feature;
    r.point = from_ + way_ * best_fraction_;
    return r;
  }

  // Everything that begins before the nearest waiting box has been looked at; a little is held back, more than rounding needs.
  [[nodiscard]] SweepResult<Real> bounded() const {
    constexpr Real kHoldBack = Real(1) - Real(1) / Real(1 << 20);
    Real known = best_fraction_;
    for (int i = 0; i < waiting_; ++i) {
      if (stack_[i].entry < known) known = stack_[i].entry;
    }
    SweepResult<Real> r;
    r.kind = SweepResult<Real>::Kind::bounded;
    r.point = from_ + way_ * (known * kHoldBack);
    return r;
  }

  const Walk<Real>& walk_;
  const GraphView<Real>& graph_;
  Vec3<Real> from_, to_, way_;
  Real from_bound_;
  Feature left_;
  Real pad_, slab_;
  Axis axes_[3];
  Real best_fraction_ = Real(1.5);  // later than any point of the way
  Target best_ = {kFree, 0};
  Waiting stack_[kMaxLevels + 2];
  int waiting_ = 0;
};

}  // namespace fdcg
