// SPDX-License-Identifier: Apache-2.0
// A geometry, the template parameter of a graph's view (graph_view.hpp) and of the whole step: it holds the graph's records and
// returns every number that depends on where corners are. This one reads them from the file. That of a mesh whose corners move
// (deform/deformable_geometry.hpp) updates a number before it returns it, so that no rule can read an old one; it has the
// members below, with the same contracts.
#pragma once

#include "base/config.hpp"
#include "fdcg/fdcg.h"
#include "graph/record_types.hpp"
#include "shared/derive.hpp"
#include "shared/vec.hpp"

namespace fdcg {

// A graph's records by their types: the same for every geometry. Not a copy of what the graph holds: a tick reads few of its
// fields.
template <class RealType>
struct GraphRecords {
  using Real = RealType;
  using Node = typename Records<Real>::Node;
  using Corner = typename Records<Real>::Corner;
  using StoredEdge = typename Records<Real>::Edge;
  using FanBox = typename Records<Real>::FanBox;

  explicit GraphRecords(const fdcg_graph& graph) : raw_(&graph) {}

  [[nodiscard]] const fdcg_header* header() const { return raw_->header; }
  [[nodiscard]] const unsigned char* nodes() const { return static_cast<const unsigned char*>(raw_->nodes); }
  [[nodiscard]] const uint32_t* node_offsets() const { return raw_->node_offsets; }  // null: each block has block_bytes
  [[nodiscard]] size_t block_bytes() const { return raw_->header->node_bytes; }
  [[nodiscard]] bool has_planes() const { return (raw_->header->flags & FDCG_STORED_PLANES) != 0; }
  [[nodiscard]] bool has_edges() const { return raw_->edges != nullptr; }
  [[nodiscard]] const fdcg_connection* connections() const { return raw_->connections; }
  [[nodiscard]] const StoredEdge* edges() const { return static_cast<const StoredEdge*>(raw_->edges); }  // null: derived
  [[nodiscard]] const Corner* corners() const { return static_cast<const Corner*>(raw_->corners); }
  [[nodiscard]] const fdcg_busy_corner* busy_corners() const { return raw_->busy_corners; }
  [[nodiscard]] const uint32_t* fans() const { return raw_->fans; }
  [[nodiscard]] const FanBox* fan_boxes() const { return static_cast<const FanBox*>(raw_->fan_boxes); }
  [[nodiscard]] const fdcg_box8* hierarchy() const { return raw_->hierarchy; }
  [[nodiscard]] const fdcg_fan_run* fan_runs() const { return raw_->fan_runs; }
  [[nodiscard]] const fdcg_node_normals* normals() const { return raw_->normals; }  // null: none
  [[nodiscard]] uint32_t fan_run_count() const { return raw_->fan_run_count; }

 private:
  const fdcg_graph* raw_;
};

template <class RealType>
struct RigidGeometry : GraphRecords<RealType> {
  using Real = RealType;
  using Corner = typename GraphRecords<Real>::Corner;

  static constexpr bool kKeepsDirections = true;                 // those in a busy corner's tree hold: its faces do not move
  static constexpr bool kHasPlanes = !FDCG_WITH_DERIVED_PLANES;  // of all sides, in every graph (load.cpp)

  static constexpr bool kGivesPlanesInPlace = kGivesInPlace;
  using StoredPlane = Given<Plane<Real>>;

  // What a NodeRef holds of its node besides the address of its block.
  struct NodeKey {
    explicit NodeKey(uint32_t) {}
  };

  using GraphRecords<Real>::GraphRecords;

  [[nodiscard]] bool has_planes() const { return kHasPlanes || GraphRecords<Real>::has_planes(); }
  [[nodiscard]] bool has_edges() const { return kHasPlanes || GraphRecords<Real>::has_edges(); }

  // Before a node's plane and flags, or a corner's normal, are read from their records.
  void bring_up_to_date(NodeKey) const {}
  void bring_normal_up_to_date(const Corner&) const {}

  [[nodiscard]] Given<Vec3<Real>> corner_point(uint32_t index) const { return point_of(this->corners()[index]); }
  [[nodiscard]] Given<Vec3<Real>> point_of(const Corner& corner) const { return given_vec(corner.point); }
  // fdcg_connection_type
  [[nodiscard]] uint8_t type_of(const fdcg_connection& connection) const { return connection.type; }

  // A connection's edge between two corners. Written number by number where it is to be: a copy would have to store
  // and reload the numbers.
  void read_edge_between(uint32_t connection, uint32_t corner0, uint32_t corner1, Edge<Real>* edge) const {
    const Corner& from = this->corners()[corner0];
    if (!has_edges()) {
      *edge = derive_edge(vec(from.point), corner_point(corner1));
      return;
    }
    const auto& stored = this->edges()[connection];
    edge->start.x = from.point[0], edge->start.y = from.point[1], edge->start.z = from.point[2];
    edge->direction.x = stored.direction[0], edge->direction.y = stored.direction[1], edge->direction.z = stored.direction[2];
    edge->length = stored.length;
  }
  // Whether a side has a Voronoi plane at all.
  [[nodiscard]] static bool has_voronoi_plane(const Edge<Real>&, Vec3<Real>) { return true; }

  // Of an exactly planar node: the first three span its plane.
  template <class Node>
  [[nodiscard]] uint32_t spanning_corner(const Node& node, uint32_t k) const {
    return node.corner(k);
  }
  // The first side inside of whose Voronoi plane a point may not be by more than `bound`; those before it surely hold it, which
  // is cheaper to test than the plane itself where planes are derived for a mesh that moves.
  template <class Node>
  [[nodiscard]] uint32_t first_doubtful(const Node&, Vec3<Real>, Real) const {
    return 0;
  }

  // How far the HIP and the surface move in a tick: the radius from which a clear ball is worth a search.
  [[nodiscard]] Real with_way_of_surface(Real way) const { return way; }
  // Whether boxes of a record of the hierarchy, a bit in `lanes` each, have become tighter than they were: worth a second look.
  [[nodiscard]] bool has_tightened(int /*level*/, uint32_t /*record*/, uint32_t /*lanes*/) const { return false; }
  // Takes all work from a sweep where the step has used up its updates.
  void bound_upkeep(uint32_t* /*work_left*/) const {}
};

}  // namespace fdcg
