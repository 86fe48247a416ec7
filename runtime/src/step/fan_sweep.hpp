// SPDX-License-Identifier: Apache-2.0
// A sweep past a busy corner (contact-model FREE-8; docs/internals/sweep.md). The boxes of the faces there all hold the corner,
// so a way past it touches them all. The file puts these faces next to one another (format.h, fdcg_fan_run), and the sweep asks
// the corner's tree of directions instead: seen from the corner a way is an arc of a great circle, and a face is met only where
// that arc passes its directions. Cost: a few boxes a level for each face of the fan that the arc passes. A short way far from
// the corner mostly touches few boxes, though, and a few nodes are looked at first (kFarNodes).
#pragma once

#include "graph/implicit_tree.hpp"
#include "step/node_entry.hpp"

namespace fdcg {

// The run of faces at a busy corner that a node is in, or FDCG_NONE. `last`: the run of another node, mostly its neighbour,
// which is asked first; or FDCG_NONE.
template <class Geometry>
uint32_t fan_run_of(const GraphView<Geometry>& graph, uint32_t n, uint32_t last) {
  if (last != FDCG_NONE && n - graph.fan_runs()[last].first_node < graph.fan_runs()[last].node_count) return last;
  uint32_t low = 0, high = graph.fan_run_count();
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    if (graph.fan_runs()[middle].first_node <= n) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low == 0) return FDCG_NONE;
  const fdcg_fan_run& run = graph.fan_runs()[low - 1];
  return n - run.first_node < run.node_count ? low - 1 : FDCG_NONE;
}

// Looks at whole fans in place of the boxes around their nodes.
template <class Geometry>
class FanSweep : public NodeEntry<Geometry> {
  using Real = typename Geometry::Real;
  using Entry = NodeEntry<Geometry>;

 public:
  using Entry::Entry;

 protected:
  using Entry::best_, Entry::from_, Entry::from_bound_, Entry::glance_at_node, Entry::graph_, Entry::is_before_best;
  using Entry::left_, Entry::slab_, Entry::to_, Entry::to_bound_, Entry::way_, Entry::work_left_;

  [[nodiscard]] bool has_runs() const { return FDCG_WITH_BUSY_CORNERS && graph_.fan_run_count() != 0; }
  // Whether the work ran out before all of a fan was looked at.
  [[nodiscard]] bool is_cut_short() const { return is_cut_short_; }

  // Whether all nodes below an item of the hierarchy (level -1: a leaf) have been looked at: by their corners' trees, a leaf's
  // others one by one. A fan is looked at once, for the first item in it.
  [[gnu::noinline, gnu::cold]] bool looked_at_fans(int level, uint32_t index) {
    const uint64_t first = uint64_t{index} * FDCG_LEAF_NODES << 3 * (level + 1), nodes = graph_.header()->node_count;
    const uint64_t beyond = first + (uint64_t{FDCG_LEAF_NODES} << 3 * (level + 1)), end = beyond < nodes ? beyond : nodes;
    if (end <= graph_.fan_runs()[0].first_node) return false;
    if (level >= 0) {
      uint32_t run = fan_run_of(graph_, static_cast<uint32_t>(first), FDCG_NONE);
      const uint32_t last = last_run(run, end);
      if (last == FDCG_NONE || (level > 0 && last > run)) return false;
      for (; run <= last; ++run) {
        if (is_by_nodes(run)) return false;
        look_at_fan(run);
      }
      return true;
    }
    spend(work_left_, kLeafWork);
    uint32_t run = FDCG_NONE;
    for (auto n = static_cast<uint32_t>(first); n < end; ++n) {
      run = fan_run_of(graph_, n, run);
      if (run == FDCG_NONE || is_by_nodes(run)) {
        glance_at_node(n);
      } else {
        look_at_fan(run);
      }
    }
    return true;
  }

 private:
  // The way as seen from a corner: from direction `start` to `end`, along a great circle. A face in a box is passed only where
  // the box meets the circle's plane within `slack`, reaches beyond the start and before the end, and, along each of its own
  // axes, comes within `padding` of what the arc spans; or it is so near to the start that a wall there might hold
  // (contact-model LEAVE-3).
  struct Arc {
    Vec3<Real> start, end;
    Vec3<Real> normal, after_start, before_end;  // of the circle's plane, and of those across it at the arc's ends
    Real slack, padding;
    Real around_start;               // negative: no wall there holds
    Real start_share, end_share;     // of the distances of the way's start and end from the corner
    Vec3<Real> outward = {0, 0, 0};  // of a face that is left there: what is behind it is not met
  };

  static constexpr uint32_t kFewFans = 3;
  static constexpr uint32_t kRemembered = 8;      // fans; one that is forgotten is looked at again
  static constexpr uint32_t kFarNodes = 20;       // a sweep looks at, before it asks a far corner's tree
  static constexpr uint32_t kPassingWork = 1200;  // of a way within rounding of a corner, for its faces there
  static constexpr Real kFarWays = 32;            // a corner is far that is as many ways away
  static constexpr Real kAnywhere = 4;            // a slack that every direction is within

  [[nodiscard]] uint64_t end_of(uint32_t run) const {
    return uint64_t{graph_.fan_runs()[run].first_node} + graph_.fan_runs()[run].node_count;
  }

  // The run that node end - 1 is in, where `run` and few others without gaps reach there; else FDCG_NONE. A record of the
  // lowest level that holds a few fans and nothing else costs as much to test as its fans.
  [[nodiscard]] uint32_t last_run(uint32_t run, uint64_t end) const {
    if (run == FDCG_NONE) return FDCG_NONE;
    for (uint32_t last = run; last < run + kFewFans; ++last) {
      if (end <= end_of(last)) return last;
      const uint32_t next = last + 1;
      if (next >= graph_.fan_run_count() || graph_.fan_runs()[next].first_node != end_of(last)) return FDCG_NONE;
    }
    return FDCG_NONE;
  }

  // Whether a fan is looked at node by node at first, as any faces are: far from the corner, of a plate's needles say, the way
  // touches few boxes, and what it meets is mostly in the first.
  [[nodiscard, gnu::noinline, gnu::cold]] bool is_by_nodes(uint32_t run) {
    if (far_nodes_left_ == 0) return false;
    const Vec3<Real> corner = graph_.corner_point(graph_.busy_corners()[graph_.fan_runs()[run].busy].corner);
    if (!(norm1(corner - from_) > kFarWays * norm1(way_))) return false;
    --far_nodes_left_;
    return true;
  }

  [[gnu::noinline, gnu::cold]] void look_at_fan(uint32_t run) {
    for (uint32_t i = 0; i < kRemembered && i < looked_at_; ++i) {
      if (fans_[i] == run) return;
    }
    fans_[looked_at_++ % kRemembered] = run;
    const fdcg_fan_run& fan = graph_.fan_runs()[run];
    const fdcg_busy_corner& busy = graph_.busy_corners()[fan.busy];
    if (left_ == Feature{FDCG_VERTEX, busy.corner}) return;  // contact-model LEAVE-1: all of its faces are left out
    Arc arc;
    passes_corner_ = false;
    if (!spans_arc(fan, busy.corner, &arc)) return;
    if (sizeof(Real) < sizeof(double) && passes_corner_) {
      pass_corner(fan, busy, arc);
    } else {
      search_fan(busy, arc);
    }
  }

  // A way within rounding of a corner: it is met where the way enters one of its faces, or where a part of the work does not
  // tell, thousands of faces being within rounding: a hand inside is to feel it in this tick.
  [[gnu::noinline, gnu::cold]] void pass_corner(const fdcg_fan_run& fan, const fdcg_busy_corner& busy, const Arc& arc) {
    if (is_cut_short_) return;  // by another fan
    uint32_t* const all_left = work_left_;
    const uint32_t lent = *all_left < kPassingWork ? *all_left : kPassingWork, before = best_.node;
    uint32_t left = lent;
    work_left_ = &left;
    search_fan(busy, arc);
    work_left_ = all_left;
    spend(all_left, lent - left);
    if (best_.node != before) {
      best_.feature = {FDCG_VERTEX, busy.corner};
    } else if (is_cut_short_) {
      meet_corner(fan, busy.corner);
    }
    is_cut_short_ = false;
  }

  // False: no face of the fan is to be asked.
  // In double: a difference of floats has no rounding there, and the plane of a fine needle's tip and a way is felt in the last
  // digits of their places.
  [[gnu::noinline, gnu::cold]] bool spans_arc(const fdcg_fan_run& fan, uint32_t corner, Arc* arc) {
    spend(work_left_, kArcWork);
    const Vec3<double> point = widen(graph_.corner_point(corner)), a = widen(from_) - point, b = widen(to_) - point;
    const Vec3<double> way = widen(to_) - widen(from_);
    const double length_a = norm(a), length_b = norm(b), length = norm(way);
    if (!(length_b > 0) || !(length > 0)) return false;  // it ends on the planes of all
    const Vec3<double> start = length_a > 0 ? a * (1 / length_a) : Vec3<double>{0, 0, 0}, end = b * (1 / length_b);
    const Vec3<double> along = way * (1 / length), across = cross(start, end);
    // Of the three products of two that have one direction that of the two shorter ones is the most accurate.
    const bool is_a_longest = length_a >= length_b && length_a >= length, is_b_longest = !is_a_longest && length_b >= length;
    const Vec3<double> normal = is_a_longest ? cross(end, along) : is_b_longest ? cross(start, along) : across;
    const double sine = norm(normal);
    const double off = is_a_longest ? sine * length_b : is_b_longest ? sine * length_a : sine * (length_a / length) * length_b;
    const double at = -dot(a, along);  // where it is nearest to the corner
    if (left_.is_free() && is_met(fan, corner, at / length, off)) return false;
    const double nearest = at > 0 && at < length ? off : length_a < length_b ? length_a : length_b;
    const bool is_inexact = (fan.flags & FDCG_RUN_INEXACT) != 0;  // and may be entered beside the way
    Real beside = is_inexact ? seen(slab_ + from_bound_ + to_bound_, static_cast<Real>(nearest)) : Real(0);
    const double bulge = dot(across, across) * 0.3;  // of an arc below a right angle over its chord, or more
    const Vec3<double> unit = sine > 0 ? normal * (1 / sine) : normal;
    arc->start = narrowed(start);
    arc->end = narrowed(end);
    arc->normal = narrowed(unit);
    arc->after_start = narrowed(cross(unit, start));
    arc->before_end = narrowed(cross(end, unit));
    beside += kDirectionRounding<Real>;
    // A wall there is off the start by its plane's rounding, and by a quarter of that beyond its sides.
    constexpr Real kOffWall = Real(1.0625);
    arc->around_start = left_.is_free() ? Real(-1) : beside + seen(kOffWall * from_bound_, static_cast<Real>(length_a));
    arc->slack = sine > kArcRounding ? beside + static_cast<Real>(kArcRounding / sine) : kAnywhere;
    arc->padding = dot(start, end) > 0 ? beside + static_cast<Real>(bulge) : kAnywhere;
    arc->start_share = static_cast<Real>(length_a / (length_a + length_b));
    arc->end_share = static_cast<Real>(length_b / (length_a + length_b));
    left_face_ = is_inexact ? FDCG_NONE : Entry::left_face_before_way(corner);
    if (left_face_ != FDCG_NONE) arc->outward = graph_.node(left_face_).normal();
    return true;
  }
  static Vec3<Real> narrowed(Vec3<double> v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
  }

  // The angle under which something is seen from a distance, or more: asin x is below 1.0625 x up to a half.
  static Real seen(Real size, Real distance) {
    return distance > 2 * size ? Real(1.0625) * size / distance : size > 0 ? kAnywhere : Real(0);
  }

  // contact-model FREE-8: a way that passes the corner within rounding meets it, and not one of thousands of faces there whose
  // sides it passes by as little. Places are exact to doubles: where these tell, only if it enters one of the faces. `at`: the
  // fraction of the way; `off`: how far from the corner.
  bool is_met(const fdcg_fan_run& fan, uint32_t corner, double at, double off) {
    const double extent = graph_.header()->extent, deviation = graph_.max_deviation();
    const Vec3<double> point = widen(graph_.corner_point(corner));
    const bool is_inexact = (fan.flags & FDCG_RUN_INEXACT) != 0;
    if (!(off <= at_corner_rounding<Real>(point, extent) + (is_inexact ? deviation : 0) && at >= 0 && at < 1)) return false;
    passes_corner_ =
        sizeof(Real) < sizeof(double) && !graph_.has_inexact_nodes() && off > at_corner_rounding<double>(point, extent);
    corner_fraction_ = static_cast<Real>(at);
    if (!passes_corner_) meet_corner(fan, corner);
    return !passes_corner_;
  }

  void meet_corner(const fdcg_fan_run& fan, uint32_t corner) {
    if (is_before_best(corner_fraction_, fan.first_node)) best_ = {corner_fraction_, fan.first_node, {FDCG_VERTEX, corner}};
  }

  // How far a box reaches from its centre in a direction.
  template <class FanBox>
  [[nodiscard, gnu::noinline, gnu::cold]] static Real reach(const FanBox& box, const Vec3<Real>& direction) {
    Real sum = 0;
    for (const auto& axis : box.axis)
      sum += absolute(dot(direction, vec(axis)));
    return sum;
  }

  static constexpr Real kPassedBy = 3;
  // The fraction of the way at which it may enter a face in the box, or less; kPassedBy: none.
  template <class FanBox>
  [[nodiscard]] Real entry_of(const FanBox& box, const Arc& arc) const {
    spend(work_left_, kArcPlaneWork);
    const Vec3<Real> centre = vec(box.centre);
    const bool is_off_plane = absolute(dot(arc.normal, centre)) - reach(box, arc.normal) > arc.slack;
    if (is_off_plane && !(arc.around_start >= 0)) return kPassedBy;
    spend(work_left_, kArcBoxWork);
    const Vec3<Real> start = arc.start - centre, end = arc.end - centre;
    bool is_at_start = arc.around_start >= 0, is_beside = false;
    for (const auto& stored : box.axis) {
      const Vec3<Real> axis = vec(stored);
      const Real from = dot(axis, start), to = dot(axis, end), size = norm1(axis), length2 = dot(axis, axis);
      const Real half = length2 + arc.padding * size;
      is_at_start = is_at_start && absolute(from) <= length2 + arc.around_start * size;
      is_beside = is_beside || (from < to ? from : to) > half || (from < to ? to : from) < -half;
      if (is_beside && !is_at_start) return kPassedBy;
    }
    if (dot(arc.outward, centre) + reach(box, arc.outward) < -kDirectionRounding<Real>) return kPassedBy;
    if (is_at_start) return 0;
    if (is_off_plane) return kPassedBy;
    const Real middle = dot(arc.after_start, centre), spread = reach(box, arc.after_start) + arc.slack;
    const Real before = dot(arc.before_end, centre) + reach(box, arc.before_end) + arc.slack;
    if (middle + spread < 0 || before < 0) return kPassedBy;
    const Real after = middle - spread;
    if (!(after > 0)) return 0;
    // Where the way has the direction p start + q end it is at q / (p + q).
    const Real q = arc.start_share * after, p = arc.end_share * before;
    return q > 0 ? q / (p + q) : Real(0);
  }

  void search_fan(const fdcg_busy_corner& busy, const Arc& arc) {
    struct Waiting {
      Real entry;
      uint32_t box;  // within its level
      int level;
    };
    const ImplicitTree layout(busy.fan_count, FDCG_LEAF_FAN);
    const auto* const boxes = graph_.fan_boxes() + busy.first_box;
    const CornerRef<Geometry> corner = graph_.corner(busy.corner);
    Waiting stack[kMaxLevels + 2];
    int waiting = 0;
    stack[waiting++] = {entry_of(boxes[0], arc), 0, layout.levels - 1};
    while (waiting > 0) {
      const Waiting next = stack[--waiting];
      if (*work_left_ == 0) is_cut_short_ = true;
      if (is_cut_short_) return;
      if (next.entry > best_.fraction + kLaterEntry<Real>) continue;  // kPassedBy is
      if (next.level == 0) {
        look_at_entries(corner, busy, next.box * FDCG_LEAF_FAN);
        continue;
      }
      const int level = next.level - 1;
      const uint32_t child = next.box * 2;
      Waiting found[2];
      int count = 0;
      for (uint32_t i = child; i < child + 2 && i < layout.size[level]; ++i) {
        const Real entry = entry_of(boxes[layout.first[level] + i], arc);
        if (entry < kPassedBy) found[count++] = {entry, i, level};
      }
      const bool is_first_later = count == 2 && found[0].entry > found[1].entry;
      if (count == 2) stack[waiting++] = found[is_first_later ? 0 : 1];
      if (count > 0) stack[waiting++] = found[is_first_later ? 1 : 0];
    }
  }

  void look_at_entries(CornerRef<Geometry> corner, const fdcg_busy_corner& busy, uint32_t first) {
    const uint32_t left = busy.fan_count - first, count = left < FDCG_LEAF_FAN ? left : FDCG_LEAF_FAN;
    for (uint32_t i = first; i < first + count; ++i) {
      const FanEntry entry = graph_.fan_entry(corner, i);
      spend(work_left_, kFanEntryWork);
      if (entry.node == FDCG_NONE) continue;
      if (sizeof(Real) < sizeof(double) &&
          (passes_corner_ ? is_beside_sector(entry) : left_face_ != FDCG_NONE && is_behind_left(entry)))
        continue;
      glance_at_node(entry.node);
    }
  }

  // Whether a face lies behind the one at the corner that a way in floats leaves, all of which is in front of that: doubles
  // tell it of floats at once. At the tip of a needle of thousands of faces a hundred are one plane but for the rounding of
  // directions.
  [[nodiscard, gnu::noinline, gnu::cold]] bool is_behind_left(const FanEntry& entry) const {
    const NodeRef<Geometry> node = graph_.node(entry.node), left = graph_.node(left_face_);
    if (surely_passes(node.plane(), from_, to_, to_bound_, slab_)) return false;
    for (uint32_t k = node.next(entry.outgoing); k != entry.outgoing; k = node.next(k)) {
      spend(work_left_, kFanSignWork);
      if (!(exact_side_sign(graph_, left, graph_.corner_point(node.corner(k)), work_left_) < 0)) return false;
    }
    return true;
  }

  // Whether a way in floats passes one of a face's two edges at the corner on the outer side: doubles tell that of floats at
  // once. Of hundreds of faces within rounding of the way that leaves a few to be asked.
  [[nodiscard, gnu::noinline, gnu::cold]] bool is_beside_sector(const FanEntry& entry) const {
    spend(work_left_, 2 * kFanSignWork);
    const NodeRef<Geometry> node = graph_.node(entry.node);
    const uint32_t k = entry.outgoing;
    return Entry::exact_orientation(node, k, node.next(k)) > 0 || Entry::exact_orientation(node, node.previous(k), k) > 0;
  }

  uint32_t fans_[kRemembered];
  uint32_t looked_at_ = 0, far_nodes_left_ = kFarNodes;
  uint32_t left_face_ = FDCG_NONE;  // at the corner, in front of which the way is
  bool is_cut_short_ = false;
  bool passes_corner_ = false;  // the fan's that is looked at, at corner_fraction_
  Real corner_fraction_ = 0;
};

}  // namespace fdcg
