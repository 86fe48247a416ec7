// SPDX-License-Identifier: Apache-2.0
// A tick that slides over the edge of its face onto the next, and there to its end, or over a few faces so: what a moving hand
// meets most. The same numbers, to the bit, as the rules of face.hpp and edge.hpp one after the other, without what serves
// other ends of theirs. Whatever is not plain is left to them: corners, borders, doubtful signs, two faces that both pull, a
// face that is met again, friction that holds, graphs that are not plain.
#pragma once

#include "step/face.hpp"

namespace fdcg {

inline constexpr uint32_t kMostHops = 4;       // far within the work of a tick
inline constexpr uint32_t kMostHopSides = 16;  // of each face

// A god-object on its way over faces.
template <class Real>
struct Hop {
  uint32_t node;
  uint32_t transitions;
  Vec3<Real> god_object;
  Vec3<Real> rounding_residual;  // contact-model FACE-7
  QuickFriction<Real> friction;
  FaceMove<Real> move;  // on the node
};

// Goes over the side that the move on its face meets (contact-model FACE-6, EDGE-1), and looks at the face beyond. False: not
// plainly so.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT bool hop_over(const GraphView<Geometry>& graph, Vec3<Real> hip, Real bound, Hop<Real>* hop) {
  const NodeRef<Geometry> here = graph.node(hop->node);
  const uint32_t k = hop->move.crossing.local_side;
  const fdcg_side& crossed = here.side(k);
  if (crossed.across == FDCG_NONE) return false;
  const NodeRef<Geometry> there = graph.node(crossed.across);
  graph.prefetch_plainly_around(there);
  const Real side = there.plane().distance(hip);
  const uint32_t back = graph.connections()[crossed.link >> 1].side[1 - (crossed.link & 1)];
  if (!(side < -bound && there.voronoi_plane(back).distance(hip) < 0 && here.voronoi_plane(k).distance(hip) >= 0)) return false;
  const Vec3<Real> from = hop->god_object, way = (hop->move.target - from) - hop->rounding_residual;
  const Vec3<Real> ahead = hop->rounding_residual + way * hop->move.crossing.fraction;
  const auto& edge = graph.edges()[crossed.link >> 1];
  const Vec3<Real> start = graph.corner_point((crossed.link & 1) == 0 ? crossed.corner : here.corner(here.next(k)));
  const Vec3<Real> direction = vec(edge.direction);
  const Real u = dot((from + ahead) - start, direction), end_tolerance = edge_end_tolerance(start, edge.length);
  if (!(u > end_tolerance && edge.length - u > end_tolerance)) return false;
  hop->god_object = start + direction * u;
  hop->rounding_residual = (from - hop->god_object) + ahead;
  hop->node = crossed.across;
  hop->transitions += 2;
  const Vec3<Real> reach = (hop->god_object - hip) + hop->rounding_residual;
  hop->move = move_on_face(there, hop->friction, hip, bound, side, hop->god_object, reach);
  return true;
}

// From the face of *hop, whose move meets a side, to where a move ends on its face. False: there is no such end near, and *hop
// is of no use.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] bool hop_to_hip(const GraphView<Geometry>& graph, Vec3<Real> hip, Real bound, Hop<Real>* hop) {
  using Kind = typename FaceMove<Real>::Kind;
  if (!graph.is_plain()) return false;
  uint32_t visited[kMostHops], hops = 0;
  do {
    if (hops == kMostHops || graph.node(hop->node).side_count() > kMostHopSides) return false;
    visited[hops++] = hop->node;
    if (!hop_over(graph, hip, bound, hop)) return false;
    for (uint32_t i = 0; i < hops; ++i) {
      if (visited[i] == hop->node) return false;
    }
  } while (hop->move.kind == Kind::crosses);
  return hop->move.kind == Kind::slides;
}

}  // namespace fdcg
