// SPDX-License-Identifier: Apache-2.0
// Edges between shaded faces (contact-model SHADE-4).
#pragma once

#include "step/shaded_face.hpp"
#include "step/walk.hpp"

namespace fdcg {

// Whether a geometry's graphs may be shaded: on a mesh whose corners move the file's normals would be wrong.
template <class Geometry>
inline constexpr bool kShades = FDCG_WITH_SHADING&& Geometry::kKeepsDirections;

template <class Geometry>
FDCG_HOT FaceFrame quick_frame_of(NodeRef<Geometry> node) {
  const Vec3<double> normal = widen(node.normal()), across = widen(node.voronoi_plane(0).normal) * -1.0;
  return {cross(across, normal), by_parts(across), by_parts(normal)};
}
template <class Geometry>
[[gnu::noinline]] FaceFrame frame_of(NodeRef<Geometry> node) {
  return quick_frame_of(node);
}

// False: no face to interpolate over.
template <class Geometry>
[[gnu::noinline]] bool make_field(const GraphView<Geometry>& graph, NodeRef<Geometry> node, const FaceFrame& frame,
                                  const fdcg_node_normals& normals, NormalField* field) {
  const Vec3<double> corners[3] = {widen(graph.corner_point(node.corner(0))), widen(graph.corner_point(node.corner(1))),
                                   widen(graph.corner_point(node.corner(2)))};
  return make_field(frame, corners, normals, field);
}

// The node's normals; null: it is not shaded.
template <class Geometry>
inline const fdcg_node_normals* normals_of(const Walk<Geometry>& walk, uint32_t node) {
  if constexpr (!kShades<Geometry>) return nullptr;
  if (walk.friction.terms == nullptr || !walk.friction.terms->shades() || node == FDCG_NONE) return nullptr;
  const fdcg_node_normals& normals = walk.friction.terms->graph->normals[node];
  return is_flat(normals) ? nullptr : &normals;
}

// The normal felt at a corner of a node: its own where it is not shaded.
template <class Geometry>
[[gnu::noinline, gnu::cold]] Vec3<double> felt_normal_at_corner(const Walk<Geometry>& walk, uint32_t node, uint32_t k) {
  const Vec3<double> normal = widen(walk.graph.node(node).normal());
  const fdcg_node_normals* const normals = normals_of(walk, node);
  return normals == nullptr ? normal : normal_at_corner(*normals, k, normal);
}

// contact-model SHADE-4: whether the faces at a connection agree along it.
template <class Geometry>
[[gnu::noinline, gnu::cold]] bool is_smooth(const Walk<Geometry>& walk, ConnectionRef<Geometry> connection) {
  const uint32_t a = connection.node(0), b = connection.node(1);
  if (b == FDCG_NONE || (normals_of(walk, a) == nullptr && normals_of(walk, b) == nullptr)) return false;
  const uint32_t start_a = connection.side(0), end_a = walk.graph.node(a).next(start_a);
  const uint32_t start_b = connection.side(1), end_b = walk.graph.node(b).next(start_b);
  const Vec3<double> first = felt_normal_at_corner(walk, a, start_a) - felt_normal_at_corner(walk, b, end_b);
  const Vec3<double> last = felt_normal_at_corner(walk, a, end_a) - felt_normal_at_corner(walk, b, start_b);
  return dot(first, first) <= square(kSmoothAcross) && dot(last, last) <= square(kSmoothAcross);
}

// The unit normal felt on a node at x.
template <class Geometry>
[[gnu::noinline, gnu::cold]] Vec3<double> felt_normal(const Walk<Geometry>& walk, uint32_t node, const Vec3<double>& x) {
  const fdcg_node_normals* const normals = normals_of(walk, node);
  if (normals != nullptr) {
    const NodeRef<Geometry> face = walk.graph.node(node);
    const FaceFrame frame = frame_of(face);
    NormalField field;
    if (make_field(walk.graph, face, frame, *normals, &field)) return normal_at(frame, field, x);
  }
  return widen(walk.graph.node(node).normal());
}

// How far the HIP is beyond a connection for each of its shaded faces: in the plane that the normal at the god-object is
// perpendicular to, as the face's rule will find it. In place of the distances from their Voronoi planes. A smooth edge holds
// nothing: of its faces the one that is less far, and that the HIP is behind, has it.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] void lean_sides(const Walk<Geometry>& walk, ConnectionRef<Geometry> connection, uint32_t index,
                                             const Real (&side)[2], Real (&voronoi)[2]) {
  const Vec3<double> god_object = widen(walk.god_object), way = widen(walk.hip) - god_object;
  for (uint32_t k = 0; k < 2; ++k) {
    const uint32_t node = connection.node(k);
    if (normals_of(walk, node) == nullptr) continue;
    const Vec3<double> direction = widen(walk.graph.edge(index).direction);
    const double beyond = dot(way, cross(direction, felt_normal(walk, node, god_object)));
    voronoi[k] = static_cast<Real>(k == 0 ? beyond : -beyond);
  }
  if (!is_smooth(walk, connection)) return;
  const uint32_t k = side[1] < 0 && (voronoi[1] < voronoi[0] || !(side[0] < 0)) ? 1 : 0;
  voronoi[k] = -1;
  voronoi[1 - k] = 1;
}

}  // namespace fdcg
