// SPDX-License-Identifier: Apache-2.0
// The free-space sweep (contact-model FREE-3, FREE-4, FREE-8; docs/internals/sweep.md): what a straight move from one point to
// another meets first.
//
// A sweep looks at the nearest boxes first. Where its work runs out (work.hpp, free_space.hpp) it is carried over to later
// ticks, which, after one more such look, go through the leaves in index order instead: one number then says how far they have
// come, and each tick gets on by at least one box. A carried sweep takes at most 2 + (boxes and nodes that the way touches) /
// (work of a tick) ticks.
#pragma once

#include "graph/box_tree.hpp"
#include "step/fan_sweep.hpp"

namespace fdcg {

// Looks for the nodes that the way may enter, and asks them.
template <class Geometry>
class Sweep : public FanSweep<Geometry> {
  using Real = typename Geometry::Real;
  using Fans = FanSweep<Geometry>;

 protected:
  using Fans::best_, Fans::from_, Fans::glance_at_node, Fans::graph_, Fans::slab_, Fans::to_, Fans::way_, Fans::work_left_;

 public:
  using Fans::Fans;

  // Nearest boxes first. False: the work ran out; what was met so far stands.
  [[gnu::noinline]] bool run(FirstHit<Real>* first) {
    best_ = *first;
    const bool is_done = graph_.hierarchy() != nullptr && search();
    *first = best_;
    return is_done;
  }

  // Where no others than these may be met (contact-model FREE-7).
  void run_near(const uint32_t* nodes, uint32_t count, FirstHit<Real>* first) {
    best_ = *first;
    for (uint32_t i = 0; i < count; ++i)
      glance_at_node(nodes[i]);
    *first = best_;
  }

  // Of a sweep that met nothing: which node it may have passed all the same, if any.
  [[nodiscard]] const FirstHit<Real>& missed() const { return Fans::missed_; }

  // In index order from *next_leaf on (a leaf of the hierarchy, or a node where there is none), which moves on by at least one.
  // False: the work ran out.
  bool run_in_order(FirstHit<Real>* first, uint32_t* next_leaf) {
    best_ = *first;
    const bool is_done = graph_.hierarchy() == nullptr ? try_all_nodes(next_leaf) : search_in_order(next_leaf);
    *first = best_;
    return is_done;
  }

 protected:
  [[gnu::noinline]] uint32_t touch(const BoxTree& tree, int level, uint32_t record, float (&entry)[FDCG_TREE_WAYS]) const {
    spend(work_left_, kBoxWork);
    const fdcg_box8& boxes = graph_.hierarchy()[tree.first[level] + record];
    const float limit = tree_fraction(best_.fraction);
    const uint32_t touched = touched_boxes(boxes, in_tree_, limit, entry) & tree.lanes(level, record);
    const bool has_tightened = graph_.has_tightened(level, record, touched);
    graph_.bound_upkeep(work_left_);
    return has_tightened ? touched & touched_boxes(boxes, in_tree_, limit, entry) : touched;
  }

  // Puts the way into tree units. A way from far away is cut to the part near the tree, lest floats lose it. False: it passes
  // by.
  [[gnu::noinline]] bool enter_tree() {
    constexpr Real kNear = 16, kEpsilon = RealLimits<Real>::kEpsilon;
    const Real per_unit = static_cast<Real>(1 / tree_unit(graph_.header()->extent));
    const Vec3<Real> from = from_ * per_unit, to = to_ * per_unit;
    const Real size = norm1(from) + norm1(to);
    if (!(size > kNear)) {
      tree_way(narrowed(from), narrowed(to - from), static_cast<float>(tree_rounding(size, size * kEpsilon)), &in_tree_);
      return true;
    }
    double begin, end;
    if (!cut_tree_way(widen(from), widen(to), &in_tree_, &begin, &end)) return false;
    part_begin_ = static_cast<Real>(begin);
    per_part_ = static_cast<Real>(1 / (end - begin));
    return true;
  }

 private:
  [[gnu::noinline, gnu::cold]] bool try_all_nodes(uint32_t* next_node) {
    for (; *next_node < graph_.header()->node_count; ++*next_node) {
      if (*work_left_ == 0) return false;
      glance_at_node(*next_node);
    }
    return true;
  }

  bool search() {
    if (!enter_tree()) return true;
    const BoxTree tree(graph_.header()->node_count);
    WaitingBoxes waiting(tree);
    while (!waiting.is_empty()) {
      if (*work_left_ == 0) return false;
      const WaitingBoxes::Item next = waiting.pop();
      if (next.key > tree_fraction(best_.fraction)) continue;
      if constexpr (Geometry::kKeepsDirections) {
        if (Fans::has_runs() && Fans::looked_at_fans(next.level, next.index)) continue;
      }
      if (next.level < 0) {
        try_leaf(next.index);
        continue;
      }
      float entry[FDCG_TREE_WAYS];
      const uint32_t touched = touch(tree, next.level, next.index, entry);
      waiting.push(next, touched, entry);
    }
    return !Fans::is_cut_short();
  }

  // Box by box: into one that the way touches, past one that it does not; up again after the last below a record. A record that
  // is at hand is not asked twice.
  [[gnu::noinline, gnu::cold]] bool search_in_order(uint32_t* next_leaf) {
    if (!enter_tree()) return true;
    const BoxTree tree(graph_.header()->node_count);
    uint32_t record[kMostTreeLevels], touched[kMostTreeLevels];
    for (uint32_t& r : record)
      r = FDCG_NONE;
    uint64_t leaf = *next_leaf;
    while (leaf < tree.leaves) {
      int level = 0;  // of the record whose box is asked, the largest that begins with this leaf
      while (level + 1 < tree.levels && (leaf >> (3 * level) & 7) == 0)
        ++level;
      for (;; --level) {
        const auto box = static_cast<uint32_t>(leaf >> (3 * level)), r = box / FDCG_TREE_WAYS;
        if (record[level] != r) {
          float entry[FDCG_TREE_WAYS];
          touched[level] = touch(tree, level, r, entry);
          record[level] = r;
        }
        if ((touched[level] >> box % FDCG_TREE_WAYS & 1) == 0) break;
        if (level > 0) continue;
        try_leaf(box);
        break;
      }
      leaf += uint64_t{1} << (3 * level);
      *next_leaf = static_cast<uint32_t>(leaf);
      if (*work_left_ == 0) return leaf >= tree.leaves;
    }
    return true;
  }

  // A fraction of the whole way as one of the part of it that is near the tree.
  [[nodiscard]] float tree_fraction(Real fraction) const {
    const Real part = (fraction - part_begin_) * per_part_;
    return part < 1 ? static_cast<float>(part) : 1.0F;
  }

  static Vec3<float> narrowed(Vec3<Real> a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
  }

  [[gnu::noinline]] void try_leaf(uint32_t leaf) {
    spend(work_left_, kLeafWork);
    const uint32_t first = leaf * FDCG_LEAF_NODES;
    const uint32_t left_in_graph = graph_.header()->node_count - first;
    const uint32_t count = left_in_graph < FDCG_LEAF_NODES ? left_in_graph : FDCG_LEAF_NODES;
    for (uint32_t n = first; n < first + count; ++n)
      glance_at_node(n);
    graph_.bound_upkeep(work_left_);
  }

  TreeWay in_tree_;
  Real part_begin_ = 0, per_part_ = 1;  // of the way: what in_tree_ covers
};

}  // namespace fdcg
