// SPDX-License-Identifier: Apache-2.0
// The god-object on an edge (contact-model EDGE-1 to EDGE-7; Melder 2004, sections 5d to 5f and 6).
#pragma once

#include "step/shaded_edge.hpp"
#include "step/walk.hpp"

namespace fdcg {

// How a HIP lies to a connection's two faces.
template <class Real>
struct EdgeSides {
  Real side[2];     // to the faces' planes
  Real voronoi[2];  // to their Voronoi planes
};

// Not as a return value: four floats would come back two to a register, by way of memory, and wait there for one another.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] void look_at_sides(Walk<Geometry>& walk, ConnectionRef<Geometry> connection, EdgeSides<Real>* sides) {
  walk.spend(kEdgeWork);
  sides->side[1] = sides->voronoi[1] = 0;  // of a boundary, which has one face
  const int faces = connection.type() == FDCG_BOUNDARY || FDCG_MUTANT("one-sided") ? 1 : 2;
  for (int k = 0; k < faces; ++k) {
    const NodeRef<Geometry> node = walk.graph.node(connection.node(k));
    sides->side[k] = walk.side(node);
    sides->voronoi[k] = distance_beyond(node, connection.side(k), walk.hip);
  }
}

// contact-model EDGE-1, SIDE-2
inline bool is_free_of_edge(uint8_t type, bool is_behind_a, bool is_behind_b) {
  return type == FDCG_CONCAVE ? !is_behind_a && !is_behind_b : !is_behind_a || !is_behind_b;
}

// contact-model EDGE-4: the sum of the two normal loads of the groove, or the paper's distance of HIP from the edge. `across`
// is HIP from its foot on the edge: from any other point of the edge it would be the same in theory, but merged faces may lie
// off their corners, and a load that is not that of the force then errs by the way along the edge.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] Real edge_load(bool has_wedge, NodeRef<Geometry> a, NodeRef<Geometry> b, const Vec3<Real>& across) {
  const Real distance = FDCG_MUTANT("edge-load-doubled") ? 2 * norm(across) : norm(across);
  if (!has_wedge) return distance;
  const Vec3<Real> sum = a.normal() + b.normal();
  const Real most = Real(kMaxWedgeFactor) * distance;
  const Real sum2 = dot(sum, sum);
  const Real load = FDCG_MUTANT("edge-load-halved") ? -dot(sum, across) : -2 * dot(sum, across);
  if (sum2 > 0 && !(load > 0)) return 0;
  return load < most * sum2 ? load / sum2 : most;  // a closed slit (sum2 = 0) has the most
}

template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void select_material_of_edge(Walk<Geometry>& walk, ConnectionRef<Geometry> connection,
                                                          const Vec3<Real>& across) {
  const uint32_t a = connection.node(0), b = connection.node(1);
  double share = 0.5;
  if (b != FDCG_NONE)
    share = share_of_load(widen(walk.graph.node(a).normal()), widen(walk.graph.node(b).normal()), widen(across));
  walk.friction.terms->select_material_of_edge(a, b, share);
}

// contact-model EDGE-1, EDGE-7: whether an edge with two faces lets the HIP go. Where corners lie off their planes the signs
// may contradict each other: far from a small face its plane is anywhere. Then a face that the HIP is clearly over, and not
// over the other, decides alone; and behind both faces of an edge that is not concave, clearly over neither, is no place.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] bool lets_go(const GraphView<Geometry>& graph, Real hip_bound, uint8_t type, const EdgeSides<Real>& s) {
  const bool is_free = is_free_of_edge(type, s.side[0] < 0, s.side[1] < 0);
  if (!graph.has_inexact_nodes()) return is_free;
  const Real noise = slab_depth(2 * graph.max_deviation(), hip_bound);
  const bool is_beyond_a = s.voronoi[0] > noise, is_beyond_b = s.voronoi[1] > noise;
  if (is_beyond_b && s.voronoi[0] < -noise) return !(s.side[0] < 0);
  if (is_beyond_a && s.voronoi[1] < -noise) return !(s.side[1] < 0);
  return is_free || (is_beyond_a && is_beyond_b && type != FDCG_CONCAVE);
}

// contact-model EDGE-5: without friction an edge holds nothing at its end; there the corner decides, which the end is.
template <class Real>
[[gnu::noinline, gnu::cold]] bool is_at_end(const EdgeLine<Real>& line, Real u) {
  return u <= line.end_tolerance || line.length - u <= line.end_tolerance;
}

// Cost: two face planes, two Voronoi planes.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Decision edge_rule(Walk<Geometry>& walk) {
  const uint32_t index = walk.active.index;
  const ConnectionRef<Geometry> connection = walk.graph.connection(index);
  EdgeSides<Real> s;
  look_at_sides(walk, connection, &s);
  if (connection.type() == FDCG_BOUNDARY)
    return go_to(s.side[0] < 0 && s.voronoi[0] < 0 ? Feature{FDCG_FACE, connection.node(0)} : kFree);
  if (lets_go(walk.graph, walk.hip_bound, connection.type(), s) && !FDCG_MUTANT("edge-never-free")) return go_to(kFree);
  if constexpr (kShades<Geometry>) {
    if (walk.friction.terms != nullptr) lean_sides(walk, connection, index, s.side, s.voronoi);
  }
  const bool is_candidate_a = s.side[0] < 0 && s.voronoi[0] < 0;
  const bool is_candidate_b = s.side[1] < 0 && s.voronoi[1] < 0;
  if (FDCG_MUTANT("edge-wrong-face") && (is_candidate_a || is_candidate_b))
    return go_to({FDCG_FACE, connection.node(is_candidate_a ? 1 : 0)});
  if (is_candidate_a && !(is_candidate_b && s.voronoi[1] < s.voronoi[0] && !FDCG_MUTANT("steeper-face")) &&
      !FDCG_MUTANT("edge-never-left"))
    return go_to({FDCG_FACE, connection.node(0)});
  if (is_candidate_b && !FDCG_MUTANT("edge-never-left")) return go_to({FDCG_FACE, connection.node(1)});

  const EdgeLine<Real> line(walk.graph, index);
  const Real foot = line.parameter(walk.hip);
  const Real ahead = line.parameter(walk.god_object) - foot;
  const Vec3<Real> across = walk.hip - (line.start + line.direction * foot);
  if constexpr (FDCG_WITH_FRICTION_TERMS) {
    if (walk.friction.terms != nullptr) select_material_of_edge(walk, connection, across);
  }
  const Real load =
      edge_load(walk.friction.has_wedge, walk.graph.node(connection.node(0)), walk.graph.node(connection.node(1)), across);
  const Slip<Real> slip = walk.friction.slip(walk.god_object, square(ahead), load);
  if (slip.is_rest && !(walk.friction.mu_static == 0 && is_at_end(line, foot + ahead))) return rest();
  place_on_edge(walk, index, line, (ahead > 0) != FDCG_MUTANT("edge-slides-past") ? foot + slip.gap : foot - slip.gap);
  return walk.seat == walk.active ? rest() : go_to(walk.seat);
}

}  // namespace fdcg
