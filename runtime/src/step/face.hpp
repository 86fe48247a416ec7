// SPDX-License-Identifier: Apache-2.0
// The god-object on a face (contact-model FACE-1 to FACE-6; Melder 2004, sections 2, 5b and 5c).
#pragma once

#include "step/shaded_edge.hpp"
#include "step/walk.hpp"

namespace fdcg {

// contact-model FACE-5: the first of the node's Voronoi planes that a move crosses; local_side is FDCG_NONE if there is none.
// GO sits on such planes all the time, so a crossing is "ends beyond, and further out than it began", not a change of sign.
//
// A move that ends on a plane up to rounding error is on that side, wherever it began: by which of the two features it goes on
// must not depend on the last digits of the god-object's place, or the next tick would choose the other. It crosses where it
// ends, unless it crosses another side before: cut to its start, one along a side would be stopped for ever. Sides of a merged
// face that are one line in the mesh are so but for its deviation, which counts as rounding there.
template <class Real>
struct Crossing {
  uint32_t local_side = FDCG_NONE;
  Real fraction = 1;
};

// Whether a place is past the ends of a side, and farther so than past those of another.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool is_farther_past_ends(NodeRef<Geometry> node, uint32_t k, uint32_t other,
                                                       const Vec3<Real>& x) {
  const Real past = past_ends(node, k, x, Real(0));
  return past > 0 && past_ends(node, other, x, Real(0)) < past;
}

// Looks at the sides from the first on beyond whose plane the move ends, or near it. Its points by reference: copied to where
// arguments are, two coordinates at once, they would wait for the stores of each.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] Crossing<Real> first_crossing_from(uint32_t k, NodeRef<Geometry> node, const Vec3<Real>& from,
                                                     const Vec3<Real>& to) {
  const Real rounding = FDCG_MUTANT("ends-on-plane") ? Real(0) : on_plane_rounding(to, node.extent());
  const Real along = node.is_inexact() ? corner_rounding(node.extent(), Real(node.graph().max_deviation())) : rounding;
  Crossing<Real> first = {FDCG_NONE, 2};  // later than any
  for (; k < node.side_count(); ++k) {
    const auto& plane = node.voronoi_plane(k);
    const Real s1 = plane.distance(to);
    if (!(s1 >= -rounding)) continue;
    const Real s0 = plane.distance(from);
    if ((FDCG_MUTANT("crossing-sign") && !(s1 * s0 < 0)) || (FDCG_MUTANT("crossing-onto") && !(s0 <= 0 && s1 > 0))) continue;
    const bool ends_there = (s1 <= along || s1 <= s0) && !FDCG_MUTANT("along-side");
    const Real fraction = ends_there ? Real(1) : s0 >= 0 ? Real(0) : -s0 / (s1 - s0);
    // A face like a needle may be narrower than rounding: of two sides that the move ends on, the one counts that reaches
    // there, or nearer to it.
    const bool is_tie = fraction == 1 && first.fraction == 1;
    if ((FDCG_MUTANT("last-crossing") ? first.local_side == FDCG_NONE || fraction > first.fraction
                                      : fraction < first.fraction) ||
        (is_tie && is_farther_past_ends(node, first.local_side, k, to)))
      first = {k, fraction};
  }
  return first;
}

// The first side inside of whose Voronoi plane a place is not by more than `bound`; side_count() if there is none.
// kIsPlain: the graph is (GraphView::is_plain).
template <bool kIsPlain = false, class Geometry, class Real = typename Geometry::Real>
FDCG_HOT uint32_t first_near_side(NodeRef<Geometry> node, Vec3<Real> x, Real bound) {
  uint32_t k = node.first_doubtful(x, bound);
  while (k < node.side_count() && !((kIsPlain ? node.stored_plane(k) : node.voronoi_plane(k)).distance(x) >= -bound))
    ++k;
  return k;
}

template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT Crossing<Real> first_crossing(NodeRef<Geometry> node, Vec3<Real> from, Vec3<Real> to, Real bound) {
  const uint32_t k = first_near_side(node, to, bound);
  return k < node.side_count() ? first_crossing_from(k, node, from, to) : Crossing<Real>{};
}

// What becomes of a god-object on a face (contact-model FACE-1 to FACE-4).
enum class FaceMoveKind {
  leaves,   // the HIP is not behind the face
  rests,    // friction holds it
  slides,   // to `target`, on the same face
  nears,    // to `target`, which may be beyond a side: meet_side() tells
  crosses,  // on its way there it meets a side
};
template <class Real>
struct FaceMove {
  using Kind = FaceMoveKind;

  Kind kind;
  Vec3<Real> target;
  Crossing<Real> crossing;
};
// The same before its sides have been looked at closely: it may near, but does not cross.
template <class Real>
struct FaceGlance {
  FaceMoveKind kind;
  uint32_t near_side;  // the first that it may be beyond
  Vec3<Real> target;
};

// `bound`: plane_rounding_bound of the HIP. `stands`: from the HIP to the god-object.
// Cost: one plane; where the god-object slides, one for each side of the node. Changes nothing but friction.is_slipping.
template <bool kIsPlain = false, class Geometry, class Laws, class Real = typename Geometry::Real>
FDCG_HOT FaceGlance<Real> glance_on_face(NodeRef<Geometry> node, Laws& friction, Vec3<Real> hip, Real bound, Real side,
                                         Vec3<Real> god_object, Vec3<Real> stands) {
  using Kind = FaceMoveKind;
  if (FDCG_MUTANT("leaves-late")) side = side - Real(1e-4) * node.extent();
  if (FDCG_MUTANT("leaves-early")) side = side + Real(1e-4) * node.extent();
  if (FDCG_MUTANT("on-plane") ? side > 0 : !(side < 0)) return {Kind::leaves, 0, god_object};
  const Vec3<Real> normal = node.normal();
  const Vec3<Real> off = stands - normal * dot(normal, stands);  // its part in the plane: from the surface point
  const Real depth = -side;
  const Real off2 = dot(off, off);
  const Slip<Real> slip = friction.slip(god_object, off2, depth);
  if (slip.is_rest) return {Kind::rests, 0, god_object};
  Vec3<Real> way = normal * depth;                   // from the HIP to the target: so far to the surface point
  if (slip.gap > 0 || FDCG_MUTANT("slides-half")) {  // else it does not wait for where the god-object is
    const Real shrink = slip.gap > 0 && off2 > 0 ? slip.gap / root(off2) : Real(0);
    const Real part = FDCG_MUTANT("slides-half") ? (1 + shrink) / 2 : FDCG_MUTANT("slides-past") ? -shrink : shrink;
    way = way + off * part;
  }
  const Vec3<Real> target = hip + way;  // contact-model FRIC-4: rounded once
  const uint32_t k = FDCG_MUTANT("rim-unseen") ? node.side_count() : first_near_side<kIsPlain>(node, target, bound);
  return {k < node.side_count() ? Kind::nears : Kind::slides, k, by_parts(target)};
}

// Of a god-object that stood at `from`. Cost: two planes for each side beyond which the target may lie.
template <class Geometry, class Real = typename Geometry::Real>
inline FaceMove<Real> meet_side(NodeRef<Geometry> node, const Vec3<Real>& from, const FaceGlance<Real>& glance) {
  using Kind = FaceMoveKind;
  if (glance.kind != Kind::nears) return {glance.kind, glance.target, {}};
  const Crossing<Real> crossing = first_crossing_from(glance.near_side, node, from, glance.target);
  return {crossing.local_side == FDCG_NONE ? Kind::slides : Kind::crosses, glance.target, crossing};
}

template <bool kIsPlain = false, class Geometry, class Laws, class Real = typename Geometry::Real>
FDCG_HOT FaceMove<Real> move_on_face(NodeRef<Geometry> node, Laws& friction, Vec3<Real> hip, Real bound, Real side,
                                     Vec3<Real> god_object, Vec3<Real> stands) {
  return meet_side(node, god_object, glance_on_face<kIsPlain>(node, friction, hip, bound, side, god_object, stands));
}

// A HIP so far away that its rounding, which is that of a slide's target too, may take the target off the plane.
template <class Geometry, class Real = typename Geometry::Real>
inline bool is_far(const GraphView<Geometry>& graph, Vec3<Real> hip) {
  return norm1(hip) > kNearExtents * Real(graph.header()->extent);
}

// Where a move that began at `from` meets the side that it crosses, but for rounding.
template <class Real>
FDCG_HOT Vec3<Real> where_it_crosses(const Vec3<Real>& from, const FaceMove<Real>& move) {
  return from + (move.target - from) * move.crossing.fraction;
}

// contact-model FACE-6: puts the place where a move crosses a side onto that side, by the node's own planes: neither the edge
// nor its corners are read, each of which may be a cache miss. False: it may be at an end of the side, since it is not inside
// of the sides before and after by more than end_rounding; or the face's corners lie off its plane; or the HIP is far away.
template <bool kIsPlain = false, class Geometry, class Real = typename Geometry::Real>
FDCG_HOT bool goes_onto_side(const Vec3<Real>& hip, NodeRef<Geometry> node, uint32_t side, Vec3<Real>* place) {
  if (node.is_inexact() || is_far(node.graph(), hip)) return false;
  const uint32_t beside[2] = {node.previous(side), node.next(side)};
  const auto& rim = kIsPlain ? node.stored_plane(side) : node.voronoi_plane(side);
  const Vec3<Real> on = *place - node.normal() * node.plane().distance(*place) - rim.normal * rim.distance(*place);
  for (const uint32_t k : beside) {
    const Real beyond = (kIsPlain ? node.stored_plane(k) : node.voronoi_plane(k)).distance(on);
    if (!(beyond < -end_rounding(node.extent()))) return false;
  }
  *place = by_parts(on);
  return true;
}

// contact-model FACE-6: seats the god-object on the rim at `point`, which the plane of this side holds. Sides in one line have
// one plane but for rounding, and for the deviation of merged faces: beyond the end of one the point is on the next. Where the
// next one turns away by more, it is at the corner.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void place_on_rim(Walk<Geometry>& walk, NodeRef<Geometry> node, uint32_t side,
                                               const Vec3<Real>& point) {
  const Real in_line = corner_rounding(node.extent(), Real(walk.graph.max_deviation()));
  const auto& plane = node.voronoi_plane(side);
  EdgeLine<Real> line(walk.graph, node, side);
  Real u = line.parameter(point);
  for (uint32_t i = 0; i < node.side_count() && (u < 0 || u > line.length); ++i) {
    walk.spend(kSideWork);
    const bool is_ahead = (u > 0) == (node.which(side) == 0);  // in winding order
    const uint32_t neighbour = is_ahead ? node.next(side) : node.previous(side);
    const uint32_t far_end = node.corner(is_ahead ? node.next(neighbour) : neighbour);
    if (absolute(plane.distance(walk.graph.corner_point(far_end))) > in_line) break;
    const EdgeLine<Real> next(walk.graph, node, neighbour);
    const Real v = next.parameter(point);
    const bool begins_here = is_ahead == (node.which(neighbour) == 0);
    if (!((begins_here ? v : next.length - v) > next.end_tolerance)) break;
    side = neighbour;
    line = next;
    u = v;
  }
  place_on_edge(walk, node.connection(side), line, u);
}

// The side on which the god-object sits within the rounding of its own place, or FDCG_NONE. Near its plane, and not past its
// ends: a face like a needle may be narrower than that rounding, and near the planes of all its sides.
template <class Geometry, class Real = typename Geometry::Real>
inline uint32_t side_under(const Walk<Geometry>& walk, NodeRef<Geometry> node) {
  const Real rounding = rim_rounding(walk.god_object, Real(walk.graph.header()->extent)) + Real(walk.graph.max_deviation());
  for (uint32_t k = 0; k < node.side_count(); ++k) {
    if (distance_beyond(node, k, walk.god_object) >= -rounding && is_between_ends(node, k, walk.god_object)) return k;
  }
  return FDCG_NONE;
}

// contact-model FACE-1: the face has lost the HIP: the seat's rule decides; without a seat this is Free. A god-object that slid
// to the face's rim but for rounding may be behind the faces across, so it is seated there first.
template <class Geometry>
[[gnu::noinline, gnu::cold]] void leave_face(Walk<Geometry>& walk, NodeRef<Geometry> node) {
  if (!walk.seat.is_free()) return;
  const uint32_t side = side_under(walk, node);
  if (side == FDCG_NONE) {
    walk.god_object = foot_on(node, walk.god_object);
  } else {
    place_on_rim(walk, node, side, walk.god_object);
  }
}

// Places the god-object where the move says. Returns what comes next.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Decision carry_out(Walk<Geometry>& walk, const FaceMove<Real>& move) {
  using Kind = typename FaceMove<Real>::Kind;
  const NodeRef<Geometry> node = walk.graph.node(walk.active.index);
  if (move.kind == Kind::leaves) {
    if (!FDCG_MUTANT("seat")) leave_face(walk, node);
    return go_to(walk.seat.is_free() || FDCG_MUTANT("seat") ? kFree : walk.seat);
  }
  if (move.kind == Kind::slides) {
    const Real off = is_far(walk.graph, walk.hip) ? distance_from(node, move.target) : Real(0);
    if (absolute(off) <= kMostOffPlane<Real> * node.extent()) walk.place(move.target - node.normal() * off, kFree);
  }
  if (move.kind != Kind::crosses) return rest();
  const uint32_t side = FDCG_MUTANT("wrong-side") ? node.next(move.crossing.local_side) : move.crossing.local_side;
  if (node.side_count() > walk.graph.kPrefetchedSides) walk.graph.prefetch_crossing(node, side);  // else it has been
  Vec3<Real> place = where_it_crosses(walk.god_object, move);
  if (goes_onto_side(walk.hip, node, side, &place)) {
    walk.rim = node.connection(side);
    walk.place(place, {FDCG_EDGE, walk.rim});
  } else {
    place_on_rim(walk, node, side, place);
  }
  if (FDCG_MUTANT("slip-flag-feature") && walk.seat.state == FDCG_EDGE) walk.friction.is_slipping = false;
  return go_to(walk.seat);
}

// shading.hpp
template <class Geometry, class Real = typename Geometry::Real>
Decision shaded_face_rule(Walk<Geometry>& walk, const fdcg_node_normals& normals);

template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Decision face_rule(Walk<Geometry>& walk) {
  const NodeRef<Geometry> node = walk.graph.node(walk.active.index);
  walk.spend(kSideWork * node.side_count());
  if constexpr (FDCG_WITH_FRICTION_TERMS) {
    if (walk.friction.terms != nullptr) {
      walk.friction.terms->select_material_of_face(walk.active.index);
      if constexpr (kShades<Geometry>) {
        const fdcg_node_normals* const normals = normals_of(walk, walk.active.index);
        if (normals != nullptr) return shaded_face_rule(walk, *normals);
      }
    }
  }
  return carry_out(walk,
                   move_on_face(node, walk.friction, walk.hip, walk.hip_bound, walk.side(node), walk.god_object, walk.gap()));
}

}  // namespace fdcg
