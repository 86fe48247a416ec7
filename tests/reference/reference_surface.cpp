// SPDX-License-Identifier: Apache-2.0
#include "reference_surface.hpp"

#include <algorithm>
#include <limits>

namespace fdcg::test {
namespace {

template <class Real, class Number>
Vector<Real> to_vector(const Number* v) {
  return {Real(v[0]), Real(v[1]), Real(v[2])};
}

}  // namespace

template <class Real>
ReferenceSurface<Real>::ReferenceSurface(const fdcg_graph& graph) {
  const fdcg_header& header = *graph.header;
  extent = header.extent;
  is_f32 = header.real_bytes == 4;
  epsilon = is_f32 ? static_cast<double>(std::numeric_limits<float>::epsilon()) : std::numeric_limits<double>::epsilon();
  metres_per_unit = header.metres_per_unit;
  std::copy_n(header.origin, 3, origin.begin());
  read(graph);
  for (Face& face : faces) {
    if (face.is_exact) derive_plane(face);
    const Vector<Real>& n = face.normal;
    coarse_planes.push_back({static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z),
                             static_cast<double>(Real(-dot(n, face.plane.point)))});
  }
  for (Edge& edge : edges)
    derive_edge(edge);
  for (Corner& corner : corners)
    derive_corner_normal(corner);
}

template <class Real>
void ReferenceSurface<Real>::read(const fdcg_graph& graph) {
  for (std::uint32_t c = 0; c < graph.header->connection_count; ++c) {
    const fdcg_connection_info record = fdcg_get_connection(&graph, c);
    Edge edge;
    for (std::size_t k = 0; k < 2; ++k) {
      edge.corner[k] = record.corner[k];
      edge.face[k] = record.node[k];
    }
    edge.type = static_cast<std::uint8_t>(record.type);
    edges.push_back(edge);
  }
  std::vector<std::uint32_t> fan(graph.header->largest_fan);
  for (std::uint32_t v = 0; v < graph.header->corner_count; ++v) {
    const fdcg_corner_info record = fdcg_get_corner(&graph, v);
    Corner corner;
    corner.point = to_vector<Real>(record.point);
    corner.is_open = record.is_open != 0;
    const std::uint32_t count = fdcg_get_fan(&graph, v, fan.data(), static_cast<std::uint32_t>(fan.size()));
    for (std::uint32_t k = 0; k < count; ++k)
      corner.connections.push_back(fan[k] >> 1);
    corners.push_back(corner);
  }
  for (std::uint32_t f = 0; f < graph.header->node_count; ++f) {
    const fdcg_node_info record = fdcg_get_node(&graph, f);
    Face face;
    for (std::uint32_t k = 0; k < record.side_count; ++k) {
      const fdcg_side_info side = fdcg_get_side(&graph, f, k);
      face.connections.push_back(side.connection);
      face.corners.push_back(side.corner);
      corners[side.corner].faces.push_back(f);
    }
    face.is_exact = (record.flags & FDCG_NODE_INEXACT) == 0;
    if (!face.is_exact) {
      const Vector<Real> n = to_vector<Real>(record.normal);
      face.plane = {n, n * Real(-Real(record.offset) / dot(n, n)), length(n)};
      face.normal = face.plane.normal();
    }
    faces.push_back(face);
  }
}

template <class Real>
void ReferenceSurface<Real>::derive_plane(Face& face) {
  const Vector<Real>& first = corners[face.corners[0]].point;
  Vector<Real> sum;
  for (std::size_t k = 1; k + 1 < face.corners.size(); ++k) {
    sum = sum + cross(corners[face.corners[k]].point - first, corners[face.corners[k + 1]].point - first);
  }
  face.plane = {sum, first, length(sum)};
  face.normal = face.plane.normal();
}

template <class Real>
void ReferenceSurface<Real>::derive_edge(Edge& edge) {
  const Vector<Real>& v0 = corners[edge.corner[0]].point;
  edge.span = corners[edge.corner[1]].point - v0;
  edge.length = length(edge.span);
  edge.direction = edge.span * Real(1 / edge.length);
  for (std::size_t k = 0; k < 2; ++k) {
    if (edge.face[k] == FDCG_NONE) continue;
    const Vector<Real>& n = faces[edge.face[k]].plane.direction;
    const Vector<Real> out = k == 0 ? cross(edge.span, n) : cross(n, edge.span);
    edge.voronoi[k] = {out, v0, length(out)};
  }
}

template <class Real>
void ReferenceSurface<Real>::derive_corner_normal(Corner& corner) {
  using std::atan2;
  const auto self = static_cast<std::uint32_t>(&corner - corners.data());
  for (const std::uint32_t f : corner.faces) {
    const Face& face = faces[f];
    const std::size_t n = face.corners.size();
    const std::size_t k =
        static_cast<std::size_t>(std::find(face.corners.begin(), face.corners.end(), self) - face.corners.begin());
    const Vector<Real> a = corners[face.corners[(k + 1) % n]].point - corner.point;
    const Vector<Real> b = corners[face.corners[(k + n - 1) % n]].point - corner.point;
    const Real angle = atan2(length(cross(a, b)), dot(a, b));
    corner.normal = corner.normal + face.normal * angle;
  }
  const Real size = length(corner.normal);
  if (size > 0) corner.normal = corner.normal * Real(1 / size);
}

template <class Real>
std::array<double, 3> ReferenceSurface<Real>::local(const double hip_object_m[3]) const {
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = hip_object_m[i] / metres_per_unit - origin[i];
    if (is_f32) result[i] = static_cast<double>(static_cast<float>(result[i]));
  }
  return result;
}

template <class Real>
std::vector<std::uint32_t> ReferenceSurface<Real>::wrong_types() const {
  std::vector<std::uint32_t> wrong;
  for (std::size_t c = 0; c < edges.size(); ++c) {
    const Edge& edge = edges[c];
    std::uint32_t type = FDCG_BOUNDARY;
    if (edge.face[1] != FDCG_NONE) {
      const Face &a = faces[edge.face[0]], &b = faces[edge.face[1]];
      if (!a.is_exact || !b.is_exact) continue;
      const Real s = dot(cross(a.plane.direction, b.plane.direction), edge.span);
      if (s == 0 && dot(a.normal, b.normal) < 0) continue;
      type = s > 0 ? FDCG_CONVEX : s < 0 ? FDCG_CONCAVE : FDCG_COPLANAR;
    }
    if (edge.type != type) wrong.push_back(static_cast<std::uint32_t>(c));
  }
  return wrong;
}

template class ReferenceSurface<long double>;
template class ReferenceSurface<Mpfr256>;
template class ReferenceSurface<HighPrecision>;

}  // namespace fdcg::test
