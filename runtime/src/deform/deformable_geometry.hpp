// SPDX-License-Identifier: Apache-2.0
// The geometry of a mesh whose corners move: the step on it is the step on any graph (graph/rigid_geometry.hpp says what each
// member is for), with its numbers updated when they are read (deform_upkeep.hpp).
#pragma once

#include "deform/deform_upkeep.hpp"
#include "graph/rigid_geometry.hpp"

namespace fdcg {

// Of the graph of a fdcg_deform alone.
template <class RealType>
struct DeformableGeometry : GraphRecords<RealType> {
  using Real = RealType;
  using Corner = typename GraphRecords<Real>::Corner;
  using NodeKey = uint32_t;  // its index

  static constexpr bool kKeepsDirections = false;
  static constexpr bool kHasPlanes = false;
  static constexpr bool kGivesPlanesInPlace = false;  // they change
  using StoredPlane = Plane<Real>;

  Upkeep<Real> upkeep;

  explicit DeformableGeometry(const fdcg_graph& graph) : GraphRecords<Real>(graph), upkeep(deform_of(graph)) {}

  void bring_up_to_date(NodeKey node) const { upkeep.bring_up_to_date(node); }
  void bring_normal_up_to_date(const Corner& corner) const { upkeep.bring_normal_up_to_date(index_of(corner)); }

  [[nodiscard]] Vec3<Real> corner_point(uint32_t index) const { return upkeep.point(index); }
  [[nodiscard]] Vec3<Real> point_of(const Corner& corner) const { return upkeep.point(index_of(corner)); }
  [[nodiscard]] uint8_t type_of(const fdcg_connection& connection) const {
    return upkeep.type(static_cast<uint32_t>(&connection - this->connections()));
  }

  void read_edge_between(uint32_t, uint32_t corner0, uint32_t corner1, Edge<Real>* edge) const {
    *edge = derive_edge_or_point(corner_point(corner0), corner_point(corner1));
  }
  [[nodiscard]] static bool has_voronoi_plane(const Edge<Real>& edge, Vec3<Real> normal) {
    return !bounds_nothing(edge.direction, normal, edge.length);
  }

  // Whether a node's corners are not all in one line.
  [[nodiscard]] bool has_area(uint32_t node) const { return !upkeep.is_sliver(node); }
  template <class Node>
  [[nodiscard]] uint32_t spanning_corner(const Node& node, uint32_t k) const {
    return upkeep.spanning_corner(node.key(), k);
  }
  template <class Node>
  [[nodiscard]] uint32_t first_doubtful(const Node& node, Vec3<Real> x, Real bound) const {
    const Vec3<Real> up = node.normal();
    const Real off_line = 2 * bound + 64 * RealLimits<Real>::kEpsilon * (norm1(x) + node.extent());
    for (uint32_t k = 0; k < 3; ++k) {
      const Vec3<Real> start = corner_point(node.corner(k)), along = corner_point(node.corner(node.next(k))) - start;
      const Real beyond = dot(cross(along, up), x - start);  // times the side's length: in winding order
      if (!(beyond < -off_line * norm1(along))) return k;
    }
    return 3;
  }

  [[nodiscard]] Real with_way_of_surface(Real way) const { return way + static_cast<Real>(upkeep.deform().tick_travel); }
  [[nodiscard]] bool has_tightened(int level, uint32_t record, uint32_t lanes) const {
    return upkeep.has_tightened(level, record, lanes);
  }
  void bound_upkeep(uint32_t* work_left) const {
    if (upkeep.deform().upkeep_left == 0) *work_left = 0;
  }

 private:
  [[nodiscard]] uint32_t index_of(const Corner& corner) const { return static_cast<uint32_t>(&corner - this->corners()); }
};

}  // namespace fdcg
