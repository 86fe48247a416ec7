// SPDX-License-Identifier: Apache-2.0
// An opened graph with its records typed, widened to double where they are read: for looking at files, not for stepping.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "fdcg/fdcg.h"

namespace fdcg::tools {

using Triple = std::array<double, 3>;

template <class T>
Triple triple(const T (&v)[3]) {
  return {v[0], v[1], v[2]};
}
inline double dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Triple minus(const Triple& a, const Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Triple& a) {
  return std::sqrt(dot(a, a));
}

struct RecordsF64 {
  using Real = double;
  using Plane = fdcg_plane_f64;
  using Node = fdcg_node_f64;
  using Connection = fdcg_connection_f64;
  using Corner = fdcg_corner_f64;
};
struct RecordsF32 {
  using Real = float;
  using Plane = fdcg_plane_f32;
  using Node = fdcg_node_f32;
  using Connection = fdcg_connection_f32;
  using Corner = fdcg_corner_f32;
};

template <class Records>
struct TypedGraph {
  const fdcg_header& header;
  const typename Records::Node* nodes;
  const std::uint32_t* sides;
  const typename Records::Plane* voronoi_planes;  // null: not stored
  const typename Records::Connection* connections;
  const typename Records::Corner* corners;
  const std::uint32_t* fans;

  explicit TypedGraph(const fdcg_graph& graph)
      : header(*graph.header),
        nodes(static_cast<const typename Records::Node*>(graph.nodes)),
        sides(graph.sides),
        voronoi_planes(static_cast<const typename Records::Plane*>(graph.voronoi_planes)),
        connections(static_cast<const typename Records::Connection*>(graph.connections)),
        corners(static_cast<const typename Records::Corner*>(graph.corners)),
        fans(graph.fans) {}

  [[nodiscard]] std::uint32_t connection_of(std::uint32_t side) const { return sides[side] >> 1; }
  [[nodiscard]] std::uint32_t start_corner(std::uint32_t side) const {
    return connections[sides[side] >> 1].corner[sides[side] & 1];
  }
};

// Calls visit with the TypedGraph that fits the file's precision.
template <class Visit>
auto visit_typed(const fdcg_graph& graph, Visit&& visit) {
  if (graph.header->real_bytes == 4) return visit(TypedGraph<RecordsF32>(graph));
  return visit(TypedGraph<RecordsF64>(graph));
}

}  // namespace fdcg::tools
