// SPDX-License-Identifier: Apache-2.0
// A god-object that stays on its edge, as in a groove or along a rim, or that a face pulls off it. The same numbers, to the
// bit, as the rule of edge.hpp, without what serves other ends of it. Whatever is not plain is left to that rule: borders,
// doubtful signs, ends. Of graphs that are not plain nothing is sure.
#pragma once

#include "step/edge.hpp"

namespace fdcg {

// A god-object on an edge, as far as that is plain.
enum class OnEdge { unsure, stays, pulled };  // pulled: by `face`
template <class Real>
struct AlongEdge {
  PlainFriction<Real> friction;
  Vec3<Real> god_object;  // where it stood, then where it stands
  bool has_slid = false;
  uint32_t face = FDCG_NONE;
};

// Points by reference: copied, two coordinates at once, they would wait for the stores of each. Unsure: nothing has changed.
// Cost: two face planes, two Voronoi planes.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::hot]] OnEdge look_along_edge(const GraphView<Geometry>& graph, uint32_t index, const Vec3<Real>& hip,
                                                   AlongEdge<Real>* along) {
  if (!graph.is_plain()) return OnEdge::unsure;
  const Real bound = plane_rounding_bound(graph, hip);
  const fdcg_connection& connection = graph.connections()[index];
  const NodeRef<Geometry> a = graph.node(connection.node);
  const uint32_t k = connection.side[0];
  const fdcg_side& first = a.side(k);
  if (first.across == FDCG_NONE) return OnEdge::unsure;
  const NodeRef<Geometry> b = graph.node(first.across);
  const EdgeSides<Real> s = {{a.plane().distance(hip), b.plane().distance(hip)},
                             {a.stored_plane(k).distance(hip), b.stored_plane(connection.side[1]).distance(hip)}};
  if (!(absolute(s.side[0]) > bound && absolute(s.side[1]) > bound)) return OnEdge::unsure;
  const bool is_behind_a = s.side[0] < 0, is_behind_b = s.side[1] < 0;
  const uint8_t type = graph.type_of(connection);
  if ((graph.has_inexact_nodes() ? lets_go(graph, bound, type, s) : is_free_of_edge(type, is_behind_a, is_behind_b)) &&
      !FDCG_MUTANT("edge-way-never-free"))
    return OnEdge::unsure;
  const bool does_a_pull = is_behind_a && s.voronoi[0] < 0, does_b_pull = is_behind_b && s.voronoi[1] < 0;
  if ((does_a_pull || does_b_pull) && !FDCG_MUTANT("edge-way-never-left")) {
    along->face = does_a_pull && !(does_b_pull && s.voronoi[1] < s.voronoi[0]) ? connection.node : first.across;
    if (FDCG_MUTANT("edge-way-wrong-face")) along->face = along->face == connection.node ? first.across : connection.node;
    return OnEdge::pulled;
  }

  const auto& edge = graph.edges()[index];
  const Vec3<Real> start = graph.corner_point((first.link & 1) == 0 ? first.corner : a.corner(a.next(k)));
  const Vec3<Real> direction = vec(edge.direction);
  const Real foot = dot(hip - start, direction), ahead = dot(along->god_object - start, direction) - foot;
  PlainFriction<Real> friction = along->friction;
  const bool is_smooth = friction.mu_static == 0 && friction.mu_dynamic == 0;
  const Real load = is_smooth ? Real(0) : edge_load(friction.has_wedge, a, b, hip - (start + direction * foot));
  const Slip<Real> slip = friction.slip(along->god_object, square(ahead), load);
  const Real u = slip.is_rest                                         ? foot + ahead
                 : (ahead > 0) != FDCG_MUTANT("edge-way-slides-past") ? foot + slip.gap
                                                                      : foot - slip.gap;
  const Real end_tolerance = end_rounding(a.extent());
  if (!(u > end_tolerance && edge.length - u > end_tolerance)) return OnEdge::unsure;
  const Vec3<Real> stands = slip.is_rest || FDCG_MUTANT("edge-way-stays") ? along->god_object : start + direction * u;
  if (!is_usable(stands)) return OnEdge::unsure;
  along->god_object = by_parts(stands);
  along->friction = friction;
  along->has_slid = !slip.is_rest;
  return OnEdge::stays;
}

}  // namespace fdcg
