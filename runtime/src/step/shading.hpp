// SPDX-License-Identifier: Apache-2.0
// Force shading by the friction cone (Melder and Harwin, "Force shading and bump mapping using the friction cone algorithm",
// World Haptics 2005; contact-model SHADE-1 to SHADE-7): on a face with normals at its corners the cone stands along the normal
// that is interpolated at the god-object. The god-object stays on the polyhedron, its faces decide what is inside. Only ticks
// with terms of friction come here.
#pragma once

#include "step/face.hpp"

namespace fdcg {

template <class Real>
inline Vec3<Real> narrowed(Vec3<double> a) {
  return {static_cast<Real>(a.x), static_cast<Real>(a.y), static_cast<Real>(a.z)};
}

// A place on a face given from the foot of a HIP that is so deep.
template <class Real>
FDCG_HOT Vec3<Real> place_of(const FaceFrame& frame, Vec3<Real> hip, double depth, Flat x) {
  return narrowed<Real>((widen(hip) + frame.normal * depth) + (frame.along * x.p + frame.across * x.q));
}
// Of a god-object's own rounding (contact-model SHADE-2).
template <class Real>
inline double slack_of(Vec3<Real> god_object) {
  return 4 * double{RealLimits<Real>::kEpsilon * norm1(god_object)};
}

// The part of move_on_face() that depends on the normal (contact-model SHADE-2, SHADE-3): whether `friction` lets the
// god-object rest, or where to it slips.
template <class Laws, class Real>
inline bool rests_on_shaded_face(const FaceFrame& frame, const NormalField& field, Laws& friction, Vec3<Real> god_object,
                                 Vec3<Real> hip, Real depth, Vec3<Real>* target) {
  ShadedSpot spot;
  look_at_spot(frame, field, widen(hip), widen(god_object - hip), double{depth}, slack_of(god_object), &spot);
  const double over = 1 / spot.size2, load = spot.load * root(over);
  const Slip<Real> slip = friction.slip(god_object, static_cast<Real>(spot.excess2 * over), static_cast<Real>(load));
  *target = god_object;
  if (slip.is_rest) return true;
  const Flat x = slip_from(spot, field, spot.god_object, slip.gap > 0 ? slip.gap / load : 0);
  *target = place_of(frame, hip, depth, x);
  return false;
}

// The same without friction: what is no farther from where it slips than its slack rests.
template <class Real>
FDCG_HOT bool rests_without_friction(const FaceFrame& frame, const NormalField& field, PlainFriction<Real>* friction,
                                     Vec3<Real> god_object, Vec3<Real> hip, Real depth, Vec3<Real>* target) {
  Flat x;
  if (!slips_at_once(frame, field, widen(hip), double{depth}, &x))
    x = slip_from_there(frame, field, widen(hip), widen(god_object - hip), double{depth}, 0);
  *target = place_of(frame, hip, depth, x);
  const Vec3<double> way = widen(*target - god_object);
  const bool is_rest = dot(way, way) <= square(kShadingSlack * double{depth} + slack_of(god_object));
  friction->is_slipping = friction->is_slipping || !is_rest;
  return is_rest;
}

// The same of two coefficients, where it is known from where the HIP was pulled in the last tick.
template <class Real>
FDCG_HOT bool rests_while_shaded(const FaceFrame& frame, const NormalField& field, PlainFriction<Real>* friction,
                                 Vec3<Real> god_object, Vec3<Real> hip, Real depth, Vec3<double> last, Vec3<Real>* target) {
  if (!(friction->mu_static > 0)) return rests_without_friction(frame, field, friction, god_object, hip, depth, target);
  ShadedSpot spot;
  look_at_spot(frame, field, widen(hip), widen(god_object - hip), double{depth}, slack_of(god_object), &spot);
  if (friction->slip(god_object, static_cast<Real>(spot.excess2), static_cast<Real>(spot.load)).is_rest) return true;
  const double mu = friction->mu_dynamic;
  Flat x;
  if (!(mu > 0) || !slips_near(spot, field, frame.flat(last), dot(frame.normal, last), mu, &x))
    x = slip_from(spot, field, {spot.god_object.p, spot.god_object.q}, mu);
  *target = place_of(frame, hip, depth, x);
  return false;
}

// move_on_face() of the active contact, as its face is.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] FaceMove<Real> move_on_facet(Walk<Geometry>& walk, NodeRef<Geometry> node, Real side) {
  const Vec3<Real> stands = walk.god_object - walk.hip;
  return move_on_face(node, walk.friction, walk.hip, walk.hip_bound, side, walk.god_object, stands);
}

// The same about the interpolated normal.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] FaceMove<Real> move_on_shaded_face(Walk<Geometry>& walk, NodeRef<Geometry> node,
                                                                const fdcg_node_normals& normals, Real side) {
  using Kind = typename FaceMove<Real>::Kind;
  const FaceFrame frame = frame_of(node);
  NormalField field;
  if (!(side < 0) || is_far(walk.graph, walk.hip) || !make_field(walk.graph, node, frame, normals, &field))
    return move_on_facet(walk, node, side);
  Vec3<Real> target;
  if (rests_on_shaded_face(frame, field, walk.friction, walk.god_object, walk.hip, -side, &target))
    return {Kind::rests, target, {}};
  const Crossing<Real> crossing = first_crossing(node, walk.god_object, target, walk.hip_bound);
  return {crossing.local_side == FDCG_NONE ? Kind::slides : Kind::crosses, target, crossing};
}

// The move of the active contact on a node, shaded or not.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] FaceMove<Real> felt_move(Walk<Geometry>& walk, uint32_t node_index) {
  const NodeRef<Geometry> node = walk.graph.node(node_index);
  walk.friction.terms->select_material_of_face(node_index);
  const fdcg_node_normals* const normals = normals_of(walk, node_index);
  const Real side = walk.side(node);
  return normals == nullptr ? move_on_facet(walk, node, side) : move_on_shaded_face(walk, node, *normals, side);
}

// Whether the face beyond a side on which the god-object is would send it back over that side.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool is_sent_back(Walk<Geometry>& walk, uint32_t beyond, uint32_t connection) {
  const bool was_slipping = walk.friction.is_slipping;
  const FaceMove<Real> back = felt_move(walk, beyond);
  walk.friction.is_slipping = was_slipping;
  walk.friction.terms->select_material_of_face(walk.active.index);
  return back.kind == FaceMove<Real>::Kind::crosses && back.crossing.fraction == 0 &&
         walk.graph.node(beyond).connection(back.crossing.local_side) == connection;
}

// A target beyond a side, put back to just within it.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] FaceMove<Real> kept_along(const Walk<Geometry>& walk, NodeRef<Geometry> node,
                                                       const FaceMove<Real>& move) {
  using Kind = typename FaceMove<Real>::Kind;
  const Plane<Real> plane = node.voronoi_plane(move.crossing.local_side);
  const Real inside = 2 * on_plane_rounding(move.target, node.extent());
  const Vec3<Real> target = move.target - plane.normal * (plane.distance(move.target) + inside);
  const Crossing<Real> crossing = first_crossing(node, walk.god_object, target, walk.hip_bound);
  return {crossing.local_side == FDCG_NONE ? Kind::slides : Kind::crosses, target, crossing};
}

// face_rule() on a shaded face. A smooth edge is no feature: the way goes on at once on the face beyond. Where both faces send
// it to the other, by rounding, it goes along the edge (SHADE-4).
template <class Geometry, class Real>
[[gnu::noinline, gnu::cold]] Decision shaded_face_rule(Walk<Geometry>& walk, const fdcg_node_normals& normals) {
  using Kind = typename FaceMove<Real>::Kind;
  const uint32_t here = walk.active.index;
  const NodeRef<Geometry> node = walk.graph.node(here);
  FaceMove<Real> move = move_on_shaded_face(walk, node, normals, walk.side(node));
  const auto across = [&](uint32_t connection_index) -> uint32_t {  // FDCG_NONE: it is no smooth edge
    const ConnectionRef<Geometry> connection = walk.graph.connection(connection_index);
    if (!is_smooth(walk, connection)) return FDCG_NONE;
    return connection.node(0) == here ? connection.node(1) : connection.node(0);
  };
  if (move.kind == Kind::crosses && move.crossing.fraction == 0) {
    const uint32_t crossed = node.connection(move.crossing.local_side), beyond = across(crossed);
    walk.spend(kEdgeWork);
    if (beyond != FDCG_NONE) {
      if (!is_sent_back(walk, beyond, crossed)) return go_to({FDCG_FACE, beyond});  // not placed once more: it would creep
      move = kept_along(walk, node, move);
    }
  }
  const Decision decision = carry_out(walk, move);
  if (move.kind != Kind::crosses || next_of(decision).state != FDCG_EDGE) return decision;
  const uint32_t beyond = across(next_of(decision).index);
  return beyond == FDCG_NONE ? decision : go_to({FDCG_FACE, beyond});
}

}  // namespace fdcg
