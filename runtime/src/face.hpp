// SPDX-License-Identifier: Apache-2.0
// The god-object on a face (contact-model section 5; Melder 2004, sections 2, 5b and 5c).
#pragma once

#include "walk.hpp"

namespace fdcg {

// The first of the node's Voronoi planes that a move crosses; local_side is FDCG_NONE if there is none. GO sits on such planes
// all the time, so a crossing is "ends on or beyond, and further out than it began", not a change of sign.
template <class Real>
struct Crossing {
  uint32_t local_side = FDCG_NONE;
  Real fraction = 1;
};

template <class Real>
inline Crossing<Real> first_crossing(NodeRef<Real> node, Vec3<Real> from, Vec3<Real> to) {
  Crossing<Real> first;
  for (uint32_t k = 0; k < node.side_count(); ++k) {
    const Plane<Real> plane = node.voronoi_plane(k);
    const Real s1 = plane.distance(to);
    if (!(s1 >= 0)) continue;
    const Real s0 = plane.distance(from);
    if (!(s1 > s0)) continue;
    const Real fraction = s0 >= 0 ? Real(0) : -s0 / (s1 - s0);
    if (first.local_side == FDCG_NONE || fraction < first.fraction) first = {k, fraction};
  }
  return first;
}

// Cost: one plane, and, where the god-object slides, two per side of the node.
template <class Real>
inline Decision face_rule(Walk<Real>& walk) {
  const NodeRef<Real> node = walk.graph.node(walk.active.index);
  const Real side = walk.side(node);
  if (!(side < 0)) return go_to(walk.seat);  // the seat's rule decides; without a seat this is Free
  const Vec3<Real> normal = node.normal();
  const Real depth = -side;
  const Vec3<Real> surface_point = walk.hip + normal * depth;
  Vec3<Real> offset = walk.god_object - surface_point;
  offset = offset - normal * dot(normal, offset);
  const Real gap = norm(offset);
  const Real allowed = friction_gap(walk, gap, depth);
  if (!(allowed < gap)) return rest();
  const Vec3<Real> target = surface_point + offset * (allowed / gap);
  const Crossing<Real> crossing = first_crossing(node, walk.god_object, target);
  if (crossing.local_side == FDCG_NONE) {
    walk.place(target, kFree);
    return rest();
  }
  const EdgeLine<Real> line(walk.graph.edge(node, crossing.local_side));
  const Vec3<Real> point = walk.god_object + (target - walk.god_object) * crossing.fraction;
  return go_to(place_on_edge(walk, node.connection(crossing.local_side), line, line.parameter(point)));
}

}  // namespace fdcg
