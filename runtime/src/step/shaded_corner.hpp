// SPDX-License-Identifier: Apache-2.0
// Corners of shaded faces (contact-model SHADE-6): where to go on from one, by the normals that are felt there.
#pragma once

#include "step/shaded_edge.hpp"

namespace fdcg {

// corner.hpp
template <class Geometry, class Real = typename Geometry::Real>
bool holds(Walk<Geometry>& walk, Feature feature);

// A busy corner's faces are found by its tree, as they are.
template <class Geometry>
[[gnu::noinline, gnu::cold]] bool is_at_shaded_face(const Walk<Geometry>& walk, CornerRef<Geometry> corner) {
  if (corner.is_busy() || corner.is_open() || !walk.friction.terms->shades()) return false;
  bool is_any = false;
  walk.graph.for_each_in_fan(corner,
                             [&](const FanEntry& entry) { is_any = is_any || normals_of(walk, entry.node) != nullptr; });
  return is_any;
}

// The face whose sector holds the way to the HIP, seen along the normal that is felt there; where normals differ and several
// do, the one along which the way is longest. None: the crease along which it is. Else it rests.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Feature next_from_shaded_corner(Walk<Geometry>& walk, CornerRef<Geometry> corner,
                                                             const Vec3<Real>& t) {
  const Vec3<double> way = widen(t);
  Feature face = walk.active, edge = walk.active;
  double longest_on_face = 0, longest_on_edge = 0;
  walk.spend(kFanWork * corner.fan_count());
  walk.graph.for_each_in_fan(corner, [&](const FanEntry& entry) {
    const NodeRef<Geometry> node = walk.graph.node(entry.node);
    const uint32_t before = node.previous(entry.outgoing);
    const auto along_loop = [&](uint32_t k) {
      const Vec3<double> direction = widen(walk.graph.edge(node, k).direction);
      return node.which(k) == 0 ? direction : direction * -1.0;
    };
    const Vec3<double> out = along_loop(entry.outgoing), in = along_loop(before);
    const Vec3<double> normal = felt_normal_at_corner(walk, entry.node, entry.outgoing);
    const Vec3<double> along = way - normal * dot(normal, way);
    const double length = dot(along, along);
    if (length > longest_on_face && dot(along, cross(out, normal)) <= 0 && dot(along, cross(in, normal)) <= 0 &&
        walk.side(node) < 0) {
      face = {FDCG_FACE, entry.node};
      longest_on_face = length;
    }
    const double forward = dot(way, out);
    if (forward > longest_on_edge && !is_smooth(walk, walk.graph.connection(entry.connection)) &&
        holds(walk, Feature{FDCG_EDGE, entry.connection})) {
      edge = {FDCG_EDGE, entry.connection};
      longest_on_edge = forward;
    }
  });
  return face == walk.active ? edge : face;
}

}  // namespace fdcg
