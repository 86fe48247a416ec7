// SPDX-License-Identifier: Apache-2.0
// Presliding (contact-model CURVE-5): the elastic displacement of a sticking contact. The rules move the anchor A, with cones
// wider by 1 / (1 - l), l = k / (k + k_p), of the stiffness k and presliding's k_p; the output god-object x lies between it and
// the surface point, where the two springs balance:
//   x = A + l (SP - A), within the face's concave edges or the edge's ends,
// which minimises k |x - HIP|^2 / 2 + k_p |x - A|^2 / 2. So with A at rest the force is conservative, and there is no creep. A
// concave edge bounds x because the wall across takes over the load of friction: A reaches the edge with no energy stored
// beyond it. Other edges do not: a triangulated plane behaves like the plane.
#pragma once

#include "step/walk.hpp"

namespace fdcg {

// Out of the half-planes that the face's concave edges leave: the nearest point of them, exactly where one or two of them
// count.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Vec3<double> within_walls(const Walk<Geometry>& walk, NodeRef<Geometry> node,
                                                       const Vec3<double>& x) {
  struct Wall {
    Vec3<double> normal;
    double beyond;
  };
  const auto farthest = [&](const Vec3<double>& point) {
    Wall worst = {{0, 0, 0}, 0};
    for (uint32_t k = 0; k < node.side_count(); ++k) {
      if (node.across(k) == FDCG_NONE || walk.graph.connection(node.connection(k)).type() != FDCG_CONCAVE) continue;
      const Plane<Real> plane = node.voronoi_plane(k);
      const double beyond = dot(widen(plane.normal), point) + double{plane.offset};
      if (beyond > worst.beyond) worst = {widen(plane.normal), beyond};
    }
    return worst;
  };
  const Wall first = farthest(x);
  if (!(first.beyond > 0)) return x;
  const Vec3<double> on_first = x - first.normal * first.beyond;
  const Wall second = farthest(on_first);
  const double rounding = wall_rounding<Real>(node.extent());
  if (!(second.beyond > rounding)) return on_first;
  // Where the two meet: x - a n_1 - b n_2, both distances 0.
  const double c = dot(first.normal, second.normal), squared_sine = 1 - c * c;
  const double out = second.beyond + c * first.beyond;  // of x, beyond the second
  if (!(squared_sine > rounding)) return on_first;
  const double a = (first.beyond - c * out) / squared_sine, b = (out - c * first.beyond) / squared_sine;
  return a >= 0 ? x - first.normal * a - second.normal * b : x - second.normal * out;
}

// Selects the material of a feature for which no rule may have selected it in this tick. At a vertex the previous stiffness is
// kept; a contact that begins there has that of an adjacent face.
template <class Geometry>
[[gnu::noinline, gnu::cold]] void select_material(const Walk<Geometry>& walk, Feature at) {
  FrictionTerms& terms = *walk.friction.terms;
  if (at.state == FDCG_FACE) terms.select_material_of_face(at.index);
  if (at.state == FDCG_EDGE) {
    const ConnectionRef<Geometry> connection = walk.graph.connection(at.index);
    terms.select_material_of_edge(connection.node(0), connection.node(1), 0.5);
  }
  if (at.state == FDCG_VERTEX) {
    const CornerRef<Geometry> corner = walk.graph.corner(at.index);
    terms.select_material_of_face(corner.is_busy() ? walk.graph.fan_entry(corner, 0).node : corner.first_node());
    if (terms.held_stiffness > 0) terms.material.stiffness_n_per_m = terms.held_stiffness;
  }
}

// The offset from the anchor to the output god-object. Cost: one plane, and those of the face's concave edges.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Vec3<double> presliding_offset(const Walk<Geometry>& walk, Feature at,
                                                            const Vec3<double>& anchor) {
  const Vec3<double> stays = {0, 0, 0}, hip = widen(walk.hip);
  const double share = 1 - 1 / walk.friction.terms->give();
  if (!(share > 0)) return stays;
  if (at.state == FDCG_FACE) {
    const NodeRef<Geometry> node = walk.graph.node(at.index);
    const Vec3<double> normal = widen(node.normal()), gap = hip - anchor;
    const Vec3<double> x = anchor + (gap - normal * dot(normal, gap)) * share;
    return within_walls(walk, node, x) - anchor;
  }
  if (at.state == FDCG_EDGE) {
    const EdgeLine<Real> line(walk.graph, at.index);
    const Vec3<double> direction = widen(line.direction);
    const double begin = dot(anchor - widen(line.start), direction), end = begin + dot(hip - anchor, direction) * share;
    return direction * ((end < 0 ? 0 : end > line.length ? double{line.length} : end) - begin);
  }
  return stays;
}

// Twice the energy of the two springs, per unit of stiffness.
inline double stored(const FrictionTerms& terms, Vec3<double> gap, Vec3<double> yielded) {
  const Vec3<double> spring = gap + yielded;
  return dot(spring, spring) + (terms.give() > 1 ? dot(yielded, yielded) / (terms.give() - 1) : 0);
}

// contact-model CURVE-7: the stiffness at the end of a tick, and the presliding offset. If the rules have moved the contact,
// from `before` and the feature `was`, the energy stored at this HIP must not exceed the energy there: the stiffness is
// reduced, and rises again as sliding dissipates. Otherwise a change of material, or a wall behind a seam, would do work on the
// hand.
template <class Geometry>
[[gnu::noinline, gnu::cold]] double settle(const Walk<Geometry>& walk, Feature was, const Vec3<double>& before) {
  FrictionTerms& terms = *walk.friction.terms;
  const Vec3<double> hip = widen(walk.hip), now = widen(walk.god_object);
  double most = 0;
  const bool has_held = terms.held_stiffness > 0;
  const bool is_still = has_held && was == walk.active && before.x == now.x && before.y == now.y && before.z == now.z;
  if (has_held && !is_still) {
    select_material(walk, was);
    most = terms.held_stiffness * stored(terms, before - hip, presliding_offset(walk, was, before));
  }
  select_material(walk, walk.active);
  terms.yielded = presliding_offset(walk, walk.active, now);
  const double own = terms.material.stiffness_n_per_m;
  if (!has_held) return own;
  if (is_still) return terms.held_stiffness < own ? terms.held_stiffness : own;
  const double is = stored(terms, now - hip, terms.yielded);
  return own * is <= most ? own : most / is;
}

}  // namespace fdcg
