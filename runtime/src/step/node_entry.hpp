// SPDX-License-Identifier: Apache-2.0
// What a straight way asks of one node (contact-model FREE-3, FREE-4, LEAVE-1, LEAVE-3; docs/internals/sweep.md): whether it
// enters it, where, and by which feature. Which nodes are asked is the sweep's business (sweep.hpp).
#pragma once

#include "base/mutation.hpp"
#include "base/work.hpp"
#include "step/walk.hpp"

namespace fdcg {

// Whether a way that is surely over a node is told from others: it asks neither the node's corners nor any sign. What is built
// for size does without.
#if FDCG_WITH_FAST_EDGES && !defined(__OPTIMIZE_SIZE__)
inline constexpr bool kTellsOver = true;
#else
inline constexpr bool kTellsOver = false;
#endif

// Whether all of a way is known to be over the face that it met first.
template <bool kIsTold>
class IsOver {
 public:
  void set(bool is_over) { is_over_ = is_over; }
  [[nodiscard]] bool get() const { return is_over_; }

 private:
  bool is_over_ = false;
};
template <>
class IsOver<false> {
 public:
  void set(bool) {}
  [[nodiscard]] bool get() const { return false; }
};

// What a way met first. The result does not depend on the order in which nodes are looked at: of two met at one fraction the
// lower one counts.
template <class Real>
struct FirstHit {
  Real fraction = Real(1.5);  // of the way; after its end: nothing met
  uint32_t node = FDCG_NONE;
  Feature feature = kFree;  // the node, or the connection that the way meets exactly
};

// Whether a way ends in front of a node's plane, or begins behind it, by more than rounding could change: it does not enter the
// node. `slab`: of the way's beginning (slab_depth).
template <class Real>
FDCG_HOT bool surely_passes(const Plane<Real>& plane, const Vec3<Real>& from, const Vec3<Real>& to, Real to_bound, Real slab) {
  const Real end = plane.distance(to);
  return end > to_bound || (end < -to_bound && plane.distance(from) < -slab);
}

// The way from -> to, leaving out the faces that meet at `left`, on which it starts; `stood`: where the god-object was before
// it stepped clear of them. Watertight: a node is entered where the line passes its edges on the inner side, by exact signs
// that two neighbours share.
template <class Geometry>
class NodeEntry {
  using Real = typename Geometry::Real;

 public:
  [[gnu::noinline]] NodeEntry(const GraphView<Geometry>& graph, const Vec3<Real>& stood, const Vec3<Real>& from,
                              const Vec3<Real>& to, Feature left, uint32_t* work_left)
      : graph_(graph),
        stood_(by_parts(stood)),
        from_(by_parts(from)),
        to_(by_parts(to)),
        way_(to_ - from_),
        from_bound_(plane_rounding_bound(graph_, from_)),
        to_bound_(plane_rounding_bound(graph_, to_)),
        left_(left),
        work_left_(work_left) {
    // On a face's plane: a corner of that face and of a neighbour may lie off both planes.
    const double deviation = graph_.max_deviation();
    slab_ = slab_depth(left_.state == FDCG_FACE ? 2 * deviation : deviation, from_bound_);
    if constexpr (FDCG_WITH_INEXACT_NODES) glance_slab_ = slab_depth(2 * deviation, from_bound_);
  }

  // Whether all of the way is known to be over the face that it meets first; not told of one met in a tick before.
  [[nodiscard]] bool is_over() const { return is_over_.get(); }
  [[nodiscard]] FDCG_ONE_COPY Vec3<Real> point_at(Real fraction) const { return from_ + way_ * fraction; }

  static constexpr Real kNever = 2;  // a fraction after the end
  // Where a way that passes inside a node's loop, and comes in at `fraction` up to rounding error, surely is over the face: of
  // one that grazes it, the roundings of two sides make `fraction` arbitrary, and its point might lie anywhere beyond the rim.
  // kNever where it is nowhere over the face: a loop that is not flat is passed, seen edge-on, by ways that end before it, and
  // by ways that pass it by.
  [[nodiscard, gnu::noinline, gnu::cold]] Real part_over(uint32_t n, Real fraction, Real least) const {
    const NodeRef<Geometry> node = graph_.node(n);
    const Real rounding = side_rounding(from_bound_, to_bound_ * fraction);  // the end may be far away, and so coarse
    const Real off = slab_ - from_bound_;                                    // corners off their planes
    Real begin = least, end = 1;
    if (!clip_to(node, rounding + off, &begin, &end)) return kNever;
    if (fraction > end) {  // come in after the way has left the node: where it surely is still over it
      Real sharp_begin = least, sharp_end = 1;
      fraction = clip_to(node, 0, &sharp_begin, &sharp_end) ? sharp_end : end;
    }
    return fraction < begin ? begin : fraction;
  }

 protected:
  // Of most nodes the way ends in front, or begins behind, by more than rounding could change: those need no call.
  void glance_at_node(uint32_t n) {
    if (surely_passes(graph_.node(n).plane(), from_, to_, to_bound_, FDCG_WITH_INEXACT_NODES ? glance_slab_ : slab_)) {
      spend(work_left_, kGlanceWork);
    } else {
      try_node(n);
    }
  }

  [[nodiscard]] bool is_before_best(Real fraction, uint32_t n) const {
    if (FDCG_MUTANT("sweep-takes-any")) return best_.node == FDCG_NONE;
    return fraction < best_.fraction || (fraction == best_.fraction && n < best_.node);
  }

  const GraphView<Geometry>& graph_;
  Vec3<Real> stood_, from_, to_, way_;
  Real from_bound_, to_bound_;
  Feature left_;
  uint32_t* work_left_;
  Real slab_;
  Real glance_slab_;  // no less than slab_, and than missed_reach
  FirstHit<Real> best_;
  FirstHit<Real> missed_;

  // How all of the way lies to a node, by more than rounding. Beside it, beyond one of its sides: neither is the node entered
  // then nor does it hold what the way left. So lie most nodes that a sweep tries, and it needs no exact sign and no corner of
  // theirs, which lie elsewhere in the file. Over it, inside of every side, where its corners lie in its plane: the way passes
  // every edge on its inner side where it meets the plane between its ends.
  enum class Lies { unsure, beside, over };
  [[nodiscard]] Lies lies_surely(NodeRef<Geometry> node) const {
    if (!Geometry::kKeepsDirections || !graph_.has_planes()) return Lies::unsure;
    const Real off = beside_rounding(slab_ + to_bound_, graph_.has_inexact_nodes());
    bool is_inside = kTellsOver && !node.is_inexact();
    uint32_t k = 0;
    for (; k < node.side_count(); ++k) {
      const auto& plane = node.stored_plane(k);
      const Real begin = plane.distance(from_);
      if (begin > off && plane.distance(to_) > off) break;
      if constexpr (kTellsOver) is_inside = is_inside && begin < -off && plane.distance(to_) < -off;
    }
    spend(work_left_, kBesideWork * (k + 1));
    if (k < node.side_count()) return Lies::beside;
    return is_inside ? Lies::over : Lies::unsure;
  }

  // On which side of the line through two corners of a node the way passes: 1 on the outer, where the node's loop runs from the
  // first to the second; 0 where the two meet exactly. What two neighbours say of their edge are exact opposites: so are the
  // rounded products.
  [[nodiscard, gnu::noinline, gnu::cold]] int exact_orientation(NodeRef<Geometry> node, uint32_t start, uint32_t end) const {
    return orient3d_sign(from_, to_, graph_.corner_point(node.corner(start)), graph_.corner_point(node.corner(end)),
                         work_left_);
  }

  // The same, rounded where that cannot matter.
  [[nodiscard, gnu::noinline, gnu::cold]] int orientation(NodeRef<Geometry> node, uint32_t start, uint32_t end) const {
    const int sign = sure_orientation(graph_.corner_point(node.corner(start)), graph_.corner_point(node.corner(end)));
    return sign != 0 ? sign : exact_orientation(node, start, end);
  }
  // The same where rounding cannot matter; else 0.
  [[nodiscard]] int sure_orientation(const Vec3<Real>& start, const Vec3<Real>& end) const {
    spend(work_left_, kOrientationWork);
    const Vec3<Real> v = start - from_, w = end - from_;
    const Real det = dot(cross(v, w), way_);
    const Real bound = orientation_rounding(v, w, way_);
    return det > bound ? 1 : det < -bound ? -1 : 0;
  }

  // How often the line passes through the loop, convex or not, from its front: through so many more of the fan's triangles from
  // the front than from behind. What neighbours share are the signs: a line that slips out of one is in the other.
  [[nodiscard, gnu::noinline, gnu::cold]] int times_wound_by(NodeRef<Geometry> node) const {
    int times = 0, first = orientation(node, 0, 1);
    for (uint32_t k = 1; k + 1 < node.side_count(); ++k) {
      const bool is_last = k + 2 == node.side_count();
      const int sign = orientation(node, 0, k + 1);
      const int diagonal = sign != 0 || is_last ? sign : -1;  // a line through a diagonal is on one side of it for both
      const int side = orientation(node, k, k + 1);
      times += first <= 0 && side <= 0 && diagonal >= 0;
      times -= first > 0 && side > 0 && diagonal < 0;
      first = diagonal;
    }
    return times;
  }

  // The face that the way leaves, or that face at the edge which it is in front of since LEAVE-2, if the corner is one of its
  // own: the way meets nothing behind that. Else FDCG_NONE.
  [[nodiscard, gnu::noinline, gnu::cold]] uint32_t left_face_before_way(uint32_t corner) const {
    const bool is_edge = left_.state == FDCG_EDGE;
    uint32_t n = left_.state == FDCG_FACE ? left_.index : FDCG_NONE;
    for (uint32_t k = 0; k < 2; ++k) {
      if (is_edge) n = graph_.connection(left_.index).node(k);
      if (n == FDCG_NONE) break;
      const NodeRef<Geometry> face = graph_.node(n);
      if (side(face, to_, to_bound_) >= 0) return has_corner(face, corner) ? n : FDCG_NONE;
    }
    return FDCG_NONE;
  }

 private:
  static constexpr uint32_t kLastBit = 63;

  // Cuts the part of the way from *begin to *end down to what is over a node, its sides moved `outwards`. False: nothing is.
  [[nodiscard, gnu::noinline, gnu::cold]] bool clip_to(NodeRef<Geometry> node, Real outwards, Real* begin, Real* end) const {
    spend(work_left_, kSideWork * node.side_count());
    bool is_beside = false;
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      const auto& plane = node.voronoi_plane(k);
      const Real s0 = plane.distance(from_) - outwards, s1 = plane.distance(to_) - outwards;
      const bool begins_inside = s0 <= 0, ends_inside = s1 <= 0;
      is_beside = is_beside || !(begins_inside || ends_inside);
      if (begins_inside == ends_inside) continue;
      const Real at = s0 / (s0 - s1);
      if (begins_inside && at < *end) *end = at;
      if (ends_inside && at > *begin) *begin = at;
    }
    return !is_beside && *begin <= *end;
  }

  // Entered from its front: the way begins in front of the plane, ends behind it, and passes inside the loop. A node whose
  // corners lie off its plane is a slab: a way that begins within the slab begins in front. In a graph with such nodes this
  // holds for all of them: a way that leaves an inexact node may begin behind the exact planes of its neighbours.
  [[gnu::noinline]] void try_node(uint32_t n) {
    spend(work_left_, kNodeWork);
    const NodeRef<Geometry> node = graph_.node(n);
    if (FDCG_MUTANT("sweep-blind") && n % 5 == 3) return;
    if (distance_from(node, to_) > to_bound_ || (is_left_out(n, node) && !FDCG_MUTANT("leave-out")))
      return;  // before any exact sign is computed
    const Lies lies = lies_surely(node);
    if (lies == Lies::beside) return;
    const Real end_side = side(node, to_, to_bound_);
    if (!(end_side < 0)) return;
    const Real start_side = side(node, from_, from_bound_);
    if (!enters(n, node, lies, start_side, end_side) && graph_.has_inexact_nodes()) may_miss(n, node, start_side, end_side);
  }

  // What try_node() asks in the end.
  [[nodiscard]] bool enters(uint32_t n, NodeRef<Geometry> node, Lies lies, Real start_side, Real end_side) {
    const bool is_slab = graph_.has_inexact_nodes();
    if (start_side < (is_slab ? -slab_ : Real(0)) && !FDCG_MUTANT("enters-from-behind")) {
      if (start_side >= -from_bound_ && !FDCG_MUTANT("seat")) try_other_wall(n, node);
      return false;
    }
    const bool is_over = kTellsOver && lies == Lies::over && start_side >= 0;  // where it meets the plane, too
    const Real fall = start_side - end_side, rounded = start_side > 0 ? start_side / fall : Real(0);
    const Real noise = from_bound_ + to_bound_ + (is_slab ? slab_ : Real(0));
    const bool is_grazing = noise > kGrazing<Real> * fall;
    const bool may_be_beside = is_grazing || is_slab;  // where it meets the plane
    const Real least = !may_be_beside ? rounded : start_side > noise ? (start_side - noise) / fall : Real(0);
    if (!is_before_best(least, n)) return false;
    const Real fraction = may_be_beside && !is_over ? part_over(n, rounded, least) : rounded;  // costs less than what follows
    if (!is_before_best(fraction, n)) return false;
    uint64_t met_exactly = 0;
    if (!is_over && !passes_inside(node, rounded, &met_exactly)) return false;
    if (met_exactly != 0 && passes_edge(node, met_exactly)) return false;
    if (FDCG_MUTANT("distance-tolerance") && left_.state != FDCG_FREE && fraction < Real(1e-4)) return false;
    best_.fraction = fraction;
    best_.node = n;
    best_.feature = {FDCG_FACE, n};
    is_over_.set(is_over);
    if (met_exactly && !FDCG_MUTANT("exact-feature")) best_.feature = on_rim(node, met_exactly, point_at(fraction));
    return true;
  }

  // Whether the way touches one edge of a node and goes on in front of the node beyond. The edge would let go: but its place on
  // the edge is rounded, and the way from there is another one.
  [[nodiscard, gnu::noinline, gnu::cold]] bool passes_edge(NodeRef<Geometry> node, uint64_t met_exactly) const {
    const bool is_one = (met_exactly & (met_exactly - 1)) == 0 && met_exactly >> kLastBit == 0;
    const uint32_t k = static_cast<uint32_t>(__builtin_ctzll(met_exactly)), across = node.across(k);
    return is_one && across != FDCG_NONE && !graph_.has_inexact_nodes() &&
           graph_.connection(node.connection(k)).type() != FDCG_CONCAVE && side(graph_.node(across), to_, to_bound_) > 0;
  }

  // Of a node that the way does not enter, and ends behind: whether the two come so near to one another that the mesh of which
  // it was merged may have been passed there. A way that ends no deeper than corners may lie is as well outside.
  [[gnu::noinline, gnu::cold]] void may_miss(uint32_t n, NodeRef<Geometry> node, Real start_side, Real end_side) {
    const Real reach = missed_reach(graph_.max_deviation(), from_bound_), fall = start_side - end_side;
    const Real deep = reach - Real(graph_.max_deviation());
    if (best_.node != FDCG_NONE || start_side < -reach || end_side > -deep) return;
    Real begin = start_side > reach ? (start_side - reach) / fall : Real(0);
    Real end = start_side + reach < fall ? (start_side + reach) / fall : Real(1);
    if (!clip_to(node, reach, &begin, &end)) return;
    const Real at = start_side > 0 ? start_side / fall : Real(0), fraction = at < begin ? begin : at < end ? at : end;
    if (!(fraction < missed_.fraction)) return;
    // Over the node; or beside it, and then by its edge: inside of all sides, but for so much, is beyond a sharp corner too.
    const Vec3<Real> point = point_at(fraction);
    Feature met = {FDCG_FACE, n};
    Real nearest2 = 4 * reach * reach;
    bool is_over = true;
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      is_over = is_over && distance_beyond(node, k, point) <= 0;
      const Real off2 = squared_distance_from_side(node, k, point);
      if (off2 < nearest2) nearest2 = off2, met = {FDCG_EDGE, node.connection(k)};
    }
    if (is_over) met = {FDCG_FACE, n};
    if (is_over || met.state == FDCG_EDGE) missed_ = {fraction, n, met};
  }
  [[nodiscard, gnu::noinline, gnu::cold]] Real squared_distance_from_side(NodeRef<Geometry> node, uint32_t k,
                                                                          const Vec3<Real>& x) const {
    const EdgeLine<Real> line(graph_, node, k);
    const Real u = line.parameter(x);
    const Vec3<Real> off = x - (line.start + line.direction * (u < 0 ? Real(0) : u > line.length ? line.length : u));
    return dot(off, off);
  }

  [[nodiscard, gnu::noinline]] Real side(NodeRef<Geometry> node, const Vec3<Real>& x, Real bound) const {
    if (absolute(distance_from(node, x)) <= bound) spend(work_left_, kNearPlaneWork);
    return side_of(graph_, node, x, bound, work_left_);
  }

  // contact-model LEAVE-1
  [[nodiscard]] bool is_left_out(uint32_t n, NodeRef<Geometry> node) const {
    if (left_.state == FDCG_FACE) return left_.index == n;
    if (left_.state == FDCG_EDGE) {
      const ConnectionRef<Geometry> connection = graph_.connection(left_.index);
      return connection.node(0) == n || connection.node(1) == n;
    }
    return left_.state == FDCG_VERTEX && has_corner(node, left_.index);
  }
  [[nodiscard]] static bool has_corner(NodeRef<Geometry> node, uint32_t corner) {
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if (node.corner(k) == corner) return true;
    }
    return false;
  }

  // contact-model LEAVE-3: a slit may be narrower than the rounding of the god-object's place, which then is behind the other
  // wall; that wall must hold it. Where the way crossed the wall cannot be told, for the same reason: it counts if the way
  // begins over it.
  [[gnu::noinline, gnu::cold]] void try_other_wall(uint32_t n, NodeRef<Geometry> node) {
    if (left_.is_free() || !is_before_best(0, n)) return;
    if (is_clearly_behind(node, from_, Real(1)) && is_clearly_behind(node, stood_, Real(1))) return;
    for (uint32_t k = 0; k < node.side_count(); ++k) {  // no further out than part_over allows, and not on its way out
      const auto& beside = node.voronoi_plane(k);
      const Real off = beside.distance(from_);
      if (off > side_rounding(from_bound_, Real(0))) return;
      if (off > 0 && (beside.distance(to_) > off || !is_between_ends(node, k, from_))) return;
    }
    if (!faces_what_was_left(node)) return;
    best_.fraction = 0;
    best_.node = n;
    best_.feature = {FDCG_FACE, n};
    is_over_.set(false);
  }

  // Whether a place is behind a node's plane by more than a share of that plane's own rounding, which of a flat or a long body
  // is much less than the bound. The offset is as good as the products at a corner that it makes up for; it may have cancelled.
  [[nodiscard, gnu::noinline, gnu::cold]] bool is_clearly_behind(NodeRef<Geometry> node, const Vec3<Real>& x,
                                                                 Real share) const {
    const Vec3<Real> corner = graph_.corner_point(node.corner(0)), normal = node.normal();
    const Plane<Real> uncancelled = {normal, norm1(Vec3<Real>{normal.x * corner.x, normal.y * corner.y, normal.z * corner.z})};
    return distance_from(node, x) < -share * own_plane_rounding(uncancelled, x);
  }

  // Whether the face or edge that the way leaves and the node are opposite each other, tested corner by corner: then the
  // god-object was in front of the node, whatever its rounded place. So it was if the step clear of the face took the way's
  // beginning behind it. The node is met only if it reaches in front of the faces that the way does not enter.
  [[nodiscard]] bool faces_what_was_left(NodeRef<Geometry> node) const {
    if (left_.state == FDCG_FACE) {
      const NodeRef<Geometry> face = graph_.node(left_.index);
      const bool is_opposite = dot(face.normal(), node.normal()) < 0;
      const bool was_before = is_opposite && side(node, stood_, from_bound_) >= 0;
      if (reaches(face, node, 1, was_before ? from_bound_ - slab_ : Real(0)) == was_before) return was_before;
      // Now of a wall all in one plane with the face, or, opposite it, whose plane's rounding does not matter.
      return !reaches(was_before ? face : node, was_before ? node : face, -1,
                      is_opposite && !was_before ? from_bound_ : Real(0));
    }
    if (left_.state != FDCG_EDGE) return false;  // at a corner its place is exact
    const ConnectionRef<Geometry> connection = graph_.connection(left_.index);
    for (uint32_t end = 0; end < 2; ++end) {
      const uint32_t corner = connection.corner(end);
      if (side_of_corner(node, corner) < 0 && is_clearly_behind(node, graph_.corner_point(corner), kCornersShare<Real>))
        return false;
    }
    const uint32_t count = connection.type() == FDCG_BOUNDARY ? 1 : 2;
    for (uint32_t k = 0; k < count; ++k) {
      const NodeRef<Geometry> face = graph_.node(connection.node(k));
      if (side(face, to_, to_bound_) >= 0 && !reaches(face, node, 1, Real(0))) return false;
    }
    return true;
  }
  // Whether a node reaches in front of a plane (`sign` 1) or behind it (-1) by more than `beyond`.
  [[nodiscard, gnu::noinline, gnu::cold]] bool reaches(NodeRef<Geometry> plane, NodeRef<Geometry> node, int sign,
                                                       Real beyond) const {
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if (side_of_corner(plane, node.corner(k)) * Real(sign) > beyond) return true;
    }
    return false;
  }
  [[nodiscard, gnu::noinline, gnu::cold]] Real side_of_corner(NodeRef<Geometry> plane, uint32_t corner) const {
    const Vec3<Real> point = graph_.corner_point(corner);
    spend(work_left_, kNodeWork);
    return side(plane, point, plane_rounding_bound(graph_, point));
  }

  // A bit for a side; the last one for all beyond.
  FDCG_ONE_COPY static uint64_t bit_of(uint32_t k) { return uint64_t{1} << (k < kLastBit ? k : kLastBit); }

  [[gnu::noinline]] bool passes_inside(NodeRef<Geometry> node, Real fraction, uint64_t* met_exactly) {
    bool must_wind = false;
    uint64_t sure = 0;  // the sides that the line surely passes on their inner side
    Vec3<Real> start = graph_.corner_point(node.corner(0));
    for (uint32_t k = 0; k < node.side_count(); ++k) {  // surely outside of one: no exact sign of another
      const Vec3<Real> end = graph_.corner_point(node.corner(node.next(k)));
      const int sign = ends_on_line(node, k) ? 0 : sure_orientation(start, end);
      if (sign > 0 && !is_open(node, k, fraction, &must_wind)) return false;
      if (sign < 0 && k < kLastBit) sure |= bit_of(k);
      start = end;
    }
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if ((sure & bit_of(k)) != 0) continue;
      const int sign = ends_on_line(node, k) ? 0 : orientation(node, k, node.next(k));
      if (sign > 0 && !is_open(node, k, fraction, &must_wind)) return false;
      if (sign == 0) *met_exactly |= bit_of(k);
    }
    if (node.side_count() == 3) remember_corner(node, *met_exactly);
    return !must_wind || times_wound_by(node) > 0;
  }

  // A line that is not in a triangle's plane and meets two of its sides meets the corner between them; so it does every other
  // side that ends there, which spares its exact sign.
  void remember_corner(NodeRef<Geometry> node, uint64_t met_exactly) {
    if (met_exactly == 3) corner_on_line_ = node.corner(1);
    if (met_exactly == 6) corner_on_line_ = node.corner(2);
    if (met_exactly == 5) corner_on_line_ = node.corner(0);
  }
  [[nodiscard]] bool ends_on_line(NodeRef<Geometry> node, uint32_t k) const {
    return node.corner(k) == corner_on_line_ || node.corner(node.next(k)) == corner_on_line_;
  }

  // Whether a way that crosses the node's plane at `fraction`, outside of this side by its orientation, may pass inside all the
  // same, where corners lie off their planes. Of a concave side where the way begins in front of the wall that stands there, or
  // in its slab, and ends in front of it, and crosses near the side or ends below the node: a way along the groove would pass
  // between the two. Of any other where the loop as it is, sides in line that bend inwards up to rounding error included, winds
  // about the way: that is still to be asked, once for all sides.
  [[nodiscard, gnu::noinline, gnu::cold]] bool is_open(NodeRef<Geometry> node, uint32_t k, Real fraction,
                                                       bool* must_wind) const {
    if (!graph_.has_inexact_nodes()) return false;
    spend(work_left_, kNodeWork);
    const bool is_near = distance_beyond(node, k, point_at(fraction)) <= slab_;
    if (graph_.connection(node.connection(k)).type() == FDCG_CONCAVE) {
      const NodeRef<Geometry> wall = graph_.node(node.across(k));
      const bool is_before = distance_from(wall, from_) >= -slab_ && distance_from(wall, to_) >= 0;
      if (is_before && (is_near || distance_beyond(node, k, to_) <= 0)) return true;
    }
    *must_wind = true;
    return is_near && node.is_inexact();
  }

  // Of a corner between two sides that the line meets, which may be in one line: whether the line meets each diagonal from
  // there.
  [[nodiscard]] bool is_on_line(NodeRef<Geometry> node, uint32_t k) const {
    for (uint32_t i = 0; i < node.side_count(); ++i) {
      if (orientation(node, k, i) != 0) return false;
    }
    return true;
  }

  // Which of the sides that the line meets exactly has the point on it: sides in one line all meet it, one holds it, or, where
  // the loop is not flat, another beside them, and then the face is met. A way in the face's own plane meets all sides, and the
  // point may be beside most of them.
  [[nodiscard, gnu::noinline, gnu::cold]] Feature on_rim(NodeRef<Geometry> node, uint64_t met_exactly,
                                                         const Vec3<Real>& point) const {
    const bool are_two = (met_exactly & (met_exactly - 1)) != 0 && met_exactly != 7;
    if (node.side_count() == 3 && are_two) return {FDCG_VERTEX, corner_on_line_};  // remember_corner() has just found it
    Feature nearest = kFree;
    Real nearest2 = 0;
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if ((met_exactly & bit_of(k)) == 0) continue;
      if (k >= kLastBit && orientation(node, k, node.next(k)) != 0) continue;
      if (!node.is_inexact() && (met_exactly & bit_of(node.previous(k))) != 0 && is_on_line(node, k))
        return {FDCG_VERTEX, node.corner(k)};
      const Real off2 = squared_distance_from_side(node, k, point);
      if (nearest.is_free() || off2 < nearest2) {
        nearest = {FDCG_EDGE, node.connection(k)};
        nearest2 = off2;
      }
    }
    return node.is_inexact() && nearest2 > slab_ * slab_ ? best_.feature : nearest;
  }

  uint32_t corner_on_line_ = FDCG_NONE;
  [[no_unique_address]] IsOver<kTellsOver> is_over_;
};

}  // namespace fdcg
