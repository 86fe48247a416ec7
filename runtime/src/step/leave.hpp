// SPDX-License-Identifier: Apache-2.0
// The start of the way to the HIP when a feature releases the god-object (contact-model LEAVE-2).
//
// The god-object is on its face or edge up to rounding error, which may put it into the solid. From there the way could pass
// below the face that it should pass over, and under the rim beyond, without ever meeting the surface from outside. So it
// starts in front, by exact sign, of those faces of which the HIP is: the faces that are left out of the sweep then lie behind
// it.
#pragma once

#include "step/walk.hpp"

namespace fdcg {

// `point`, moved along `outward` by as little as puts it in front of the node's plane: a slit may be narrower than a rounding.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Vec3<Real> in_front_of(Walk<Geometry>& walk, NodeRef<Geometry> node, Vec3<Real> point,
                                                    Vec3<Real> outward) {
  constexpr int kMostMoves = 16;  // each twice the one before
  const Real bound = plane_rounding_bound(walk.graph, point);
  const Real least = least_step_clear<Real>(walk.graph.header()->extent);
  const Real behind = absolute(node.plane().distance(point));
  Real step = behind > least ? behind : least;
  for (int i = 0; i < kMostMoves; ++i, step = 2 * step) {
    if (side_of(walk.graph, node, point, bound, &walk.work_left) >= 0) break;
    point = point + outward * step;
  }
  return point;
}

// Call before the sweep that leaves `left`, whose rule has found the HIP outside.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void step_clear_of(Walk<Geometry>& walk, Feature left) {
  if (left.state == FDCG_FACE) {
    const NodeRef<Geometry> node = walk.graph.node(left.index);
    walk.god_object = in_front_of(walk, node, walk.god_object, node.normal());
  } else if (left.state == FDCG_EDGE) {
    const ConnectionRef<Geometry> connection = walk.graph.connection(left.index);
    const NodeRef<Geometry> a = walk.graph.node(connection.node(0));
    if (connection.type() == FDCG_BOUNDARY) {
      if (walk.side(a) >= 0) walk.god_object = in_front_of(walk, a, walk.god_object, a.normal());
      return;
    }
    const NodeRef<Geometry> b = walk.graph.node(connection.node(1));
    if (connection.type() == FDCG_CONCAVE) {  // the HIP is in front of both
      const Vec3<Real> outward = a.normal() + b.normal();
      const Vec3<Real> off_a = in_front_of(walk, a, walk.god_object, outward);
      walk.god_object = in_front_of(walk, b, off_a, outward);
    } else {  // ... of one: all of the other lies behind that one's plane
      const NodeRef<Geometry> passed = walk.side(a) >= 0 ? a : b;
      walk.god_object = in_front_of(walk, passed, walk.god_object, passed.normal());
    }
  }
}

}  // namespace fdcg
