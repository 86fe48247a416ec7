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
inline Crossing<Real> first_crossing(const GraphView<Real>& graph, const typename Records<Real>::Node& node, Vec3<Real> from,
                                     Vec3<Real> to) {
  Crossing<Real> first;
  for (uint32_t k = 0; k < node.side_count; ++k) {
    const Plane<Real> plane = graph.voronoi_plane(node, k);
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
[[gnu::always_inline]] inline Decision face_rule(Walk<Real>& walk) {
  const auto& node = walk.graph.nodes[walk.active.index];
  const Real side = walk.side(node);
  if (!(side < 0)) return go_to(walk.seat);  // the seat's rule decides; without a seat this is Free
  const Vec3<Real> normal = vec(node.plane.normal);
  const Vec3<Real> reach = walk.god_object - walk.hip;
  const Vec3<Real> offset = reach - normal * dot(normal, reach);  // its part in the plane: from the surface point
  const Real gap2 = dot(offset, offset), depth = -side;
  const Slip<Real> slip = friction(walk, gap2, depth);
  if (slip.is_rest) return rest();
  const Real shrink = slip.gap > 0 ? slip.gap / root(gap2) : Real(0);
  const Vec3<Real> surface_point = walk.hip + normal * depth;
  const Vec3<Real> target = surface_point + offset * shrink;
  const Crossing<Real> crossing = first_crossing(walk.graph, node, walk.god_object, target);
  if (crossing.local_side == FDCG_NONE) {
    walk.place(target, kFree);
    return rest();
  }
  const uint32_t connection = walk.graph.sides[node.first_side + crossing.local_side] >> 1;
  const EdgeLine<Real> line(walk.graph, walk.graph.connections[connection]);
  const Vec3<Real> point = walk.god_object + (target - walk.god_object) * crossing.fraction;
  return go_to(place_on_edge(walk, connection, line, line.parameter(point)));
}

}  // namespace fdcg
