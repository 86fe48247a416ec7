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

// Moves the god-object along `outward` by as little as puts it in front of the node's plane: a slit may be narrower than a
// rounding, and a groove between merged faces not much wider than they are off their corners.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void step_in_front_of(Walk<Geometry>& walk, NodeRef<Geometry> node, const Vec3<Real>& outward) {
  constexpr int kMostMoves = 16;  // onto the plane; then the least step, and each twice the one before
  const Real bound = plane_rounding_bound(walk.graph, walk.god_object);
  const Real least = least_step_clear<Real>(walk.graph.header()->extent);
  const Real behind = absolute(distance_from(node, walk.god_object));
  Real step = behind > least ? behind : least;
  for (int i = 0; i < kMostMoves; ++i, step = i == 1 ? least : 2 * step) {
    if (side_of(walk.graph, node, walk.god_object, bound, &walk.work_left) >= 0) break;
    walk.god_object = walk.god_object + outward * step;
  }
}

// Call before the sweep that leaves `left`, whose rule has found the HIP outside.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void step_clear_of(Walk<Geometry>& walk, Feature left) {
  if (left.state != FDCG_FACE && left.state != FDCG_EDGE) return;
  uint32_t passed = left.index;
  if (left.state == FDCG_EDGE) {
    const ConnectionRef<Geometry> connection = walk.graph.connection(left.index);
    passed = connection.node(0);
    const NodeRef<Geometry> a = walk.graph.node(passed);
    if (connection.type() == FDCG_CONCAVE) {  // the HIP is in front of both
      const NodeRef<Geometry> b = walk.graph.node(connection.node(1));
      const Vec3<Real> sum = a.normal() + b.normal(), outward = sum * (1 / (norm(sum) + RealLimits<Real>::kTiny));
      step_in_front_of(walk, a, outward);
      return step_in_front_of(walk, b, outward);
    }
    if (walk.side(a) < 0) {  // ... of the other: all of this one lies behind that one's plane
      if (connection.type() == FDCG_BOUNDARY) return;
      passed = connection.node(1);
    }
  }
  const NodeRef<Geometry> node = walk.graph.node(passed);
  step_in_front_of(walk, node, node.normal());
}

}  // namespace fdcg
