// SPDX-License-Identifier: Apache-2.0
// A graph with its records typed: what the step reads, and the few expressions that every rule shares.
#pragma once

#include "exact_orient.hpp"
#include "fdcg/fdcg.h"
#include "vec.hpp"

namespace fdcg {

template <class Real>
struct Records;
template <>
struct Records<double> {
  using Plane = fdcg_plane_f64;
  using Node = fdcg_node_f64;
  using Connection = fdcg_connection_f64;
  using Corner = fdcg_corner_f64;
  using FanBox = fdcg_fan_box_f64;
};
template <>
struct Records<float> {
  using Plane = fdcg_plane_f32;
  using Node = fdcg_node_f32;
  using Connection = fdcg_connection_f32;
  using Corner = fdcg_corner_f32;
  using FanBox = fdcg_fan_box_f32;
};

// normal.x + offset: positive outside.
template <class Real>
struct Plane {
  Vec3<Real> normal;
  Real offset;

  [[nodiscard]] Real distance(Vec3<Real> x) const { return dot(normal, x) + offset; }
};

template <class Real>
struct GraphView {
  using Node = typename Records<Real>::Node;
  using Connection = typename Records<Real>::Connection;
  using Corner = typename Records<Real>::Corner;
  using FanBox = typename Records<Real>::FanBox;

  const fdcg_header* header;
  const Node* nodes;
  const uint32_t* sides;
  const typename Records<Real>::Plane* voronoi_planes;  // null: derived
  const Connection* connections;
  const Corner* corners;
  const uint32_t* fans;
  const FanBox* fan_boxes;
  const fdcg_box* hierarchy;

  explicit GraphView(const fdcg_graph& graph)
      : header(graph.header),
        nodes(static_cast<const Node*>(graph.nodes)),
        sides(graph.sides),
        voronoi_planes(static_cast<const typename Records<Real>::Plane*>(graph.voronoi_planes)),
        connections(static_cast<const Connection*>(graph.connections)),
        corners(static_cast<const Corner*>(graph.corners)),
        fans(graph.fans),
        fan_boxes(static_cast<const FanBox*>(graph.fan_boxes)),
        hierarchy(graph.hierarchy) {}

  [[nodiscard]] Plane<Real> face_plane(const Node& node) const { return {vec(node.plane.normal), node.plane.offset}; }

  [[nodiscard]] Vec3<Real> corner_point(uint32_t corner) const { return vec(corners[corner].point); }

  // The corner at which a side starts, in its node's winding order.
  [[nodiscard]] uint32_t start_corner(uint32_t side) const { return connections[sides[side] >> 1].corner[sides[side] & 1]; }

  // Through the edge, normal pointing out of the face: m_0 = e x n_0, m_1 = n_1 x e (contact-model section 2).
  [[nodiscard]] Plane<Real> voronoi_plane(const Node& node, uint32_t local_side) const {
    const uint32_t side = node.first_side + local_side;
    if (voronoi_planes != nullptr) return {vec(voronoi_planes[side].normal), voronoi_planes[side].offset};
    const Connection& connection = connections[sides[side] >> 1];
    const Vec3<Real> e = vec(connection.edge), n = vec(node.plane.normal);
    const Vec3<Real> out = (sides[side] & 1) == 0 ? cross(e, n) : cross(n, e);
    const Real length = norm(out);
    const Vec3<Real> m = {out.x / length, out.y / length, out.z / length};
    return {m, -dot(m, corner_point(connection.corner[0]))};
  }
};

// Beyond this distance from a face's plane, rounding cannot have changed the sign of Plane::distance at x: the stored normal is
// good to two units in the last place, the offset to one, the sum to three.
template <class Real>
inline Real plane_rounding_bound(const GraphView<Real>& graph, Vec3<Real> x) {
  return 8 * RealLimits<Real>::kEpsilon * (norm1(x) + 2 * static_cast<Real>(graph.header->extent));
}

// The sign of x against the plane through the first three corners of an exactly planar node.
template <class Real>
int exact_side_sign(const GraphView<Real>& graph, const typename Records<Real>::Node& node, Vec3<Real> x) {
  Vec3<double> corner[3];
  for (uint32_t k = 0; k < 3; ++k)
    corner[k] = widen(graph.corner_point(graph.start_corner(node.first_side + k)));
  return orient3d_sign(corner[0], corner[1], corner[2], widen(x));
}

// side(x) of the contact model: the distance of x from the face's plane, with its exact sign where the face is exactly planar.
// `bound` is plane_rounding_bound of x. One expression wherever it is asked, so that no two rules disagree.
template <class Real>
inline Real side_of(const GraphView<Real>& graph, const typename Records<Real>::Node& node, Vec3<Real> x, Real bound) {
  const Real distance = graph.face_plane(node).distance(x);
  if (absolute(distance) > bound || (node.flags & FDCG_NODE_INEXACT) != 0) return distance;
  const int sign = exact_side_sign(graph, node, x);
  if (sign == 0) return 0;
  if (sign > 0) return distance > 0 ? distance : RealLimits<Real>::kTiny;
  return distance < 0 ? distance : -RealLimits<Real>::kTiny;
}

}  // namespace fdcg
