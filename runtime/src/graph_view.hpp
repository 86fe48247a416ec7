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
struct GraphView;

// One node, by value: a few pointers. `k` counts its sides from 0, in winding order.
template <class Real>
class NodeRef {
 public:
  NodeRef(const GraphView<Real>& graph, uint32_t index) : graph_(&graph), record_(&graph.nodes[index]) {}

  [[nodiscard]] uint32_t side_count() const { return record_->side_count; }
  // Its corners lie off its plane, by up to header.max_deviation.
  [[nodiscard]] bool is_inexact() const { return (record_->flags & FDCG_NODE_INEXACT) != 0; }
  [[nodiscard]] Vec3<Real> normal() const { return vec(record_->plane.normal); }
  [[nodiscard]] Plane<Real> plane() const { return {normal(), record_->plane.offset}; }

  [[nodiscard]] uint32_t connection(uint32_t k) const { return link(k) >> 1; }
  // Which of the connection's nodes this one is: 0 or 1.
  [[nodiscard]] uint32_t which(uint32_t k) const { return link(k) & 1; }
  // The corner at which side k starts.
  [[nodiscard]] uint32_t corner(uint32_t k) const { return graph_->connections[connection(k)].corner[which(k)]; }
  // The node beyond side k, or FDCG_NONE.
  [[nodiscard]] uint32_t across(uint32_t k) const { return graph_->connections[connection(k)].node[1 - which(k)]; }
  [[nodiscard]] uint32_t previous(uint32_t k) const { return (k == 0 ? side_count() : k) - 1; }
  [[nodiscard]] uint32_t next(uint32_t k) const { return k + 1 < side_count() ? k + 1 : 0; }

  // Through side k's edge, normal pointing out of the face: m_0 = e x n_0, m_1 = n_1 x e (contact-model section 2).
  [[nodiscard]] Plane<Real> voronoi_plane(uint32_t k) const {
    if (graph_->voronoi_planes != nullptr) {
      const auto& stored = graph_->voronoi_planes[record_->first_side + k];
      return {vec(stored.normal), stored.offset};
    }
    const auto& connection_record = graph_->connections[connection(k)];
    const Vec3<Real> e = vec(connection_record.edge);
    const Vec3<Real> out = which(k) == 0 ? cross(e, normal()) : cross(normal(), e);
    const Real length = norm(out);
    const Vec3<Real> m = {out.x / length, out.y / length, out.z / length};
    return {m, -dot(m, graph_->corner_point(connection_record.corner[0]))};
  }

 private:
  [[nodiscard]] uint32_t link(uint32_t k) const { return graph_->sides[record_->first_side + k]; }

  const GraphView<Real>* graph_;
  const typename Records<Real>::Node* record_;
};

// One connection, by value.
template <class Real>
class ConnectionRef {
 public:
  ConnectionRef(const GraphView<Real>& graph, uint32_t index) : record_(&graph.connections[index]) {}

  [[nodiscard]] uint8_t type() const { return record_->type; }                // fdcg_connection_type
  [[nodiscard]] uint32_t node(uint32_t k) const { return record_->node[k]; }  // k = 1: FDCG_NONE on a boundary
  [[nodiscard]] uint32_t side(uint32_t k) const { return record_->side[k]; }  // which side of node(k) this is
  [[nodiscard]] uint32_t corner(uint32_t end) const { return record_->corner[end]; }

 private:
  const typename Records<Real>::Connection* record_;
};

// A connection's line: start + u direction, 0 <= u <= length, from corner 0 to corner 1.
template <class Real>
struct Edge {
  Vec3<Real> start, direction;
  Real length;
};

// One entry of a corner's fan: a connection that leaves the corner from its end `end`, and the node to its left (FDCG_NONE
// where an open fan ends), of which it is the side `outgoing`.
struct FanEntry {
  uint32_t connection, end, node, outgoing;
};

template <class Real>
class CornerRef {
 public:
  CornerRef(const GraphView<Real>& graph, uint32_t index) : record_(&graph.corners[index]) {}

  [[nodiscard]] Vec3<Real> point() const { return vec(record_->point); }
  [[nodiscard]] bool is_open() const { return (record_->flags & FDCG_CORNER_OPEN) != 0; }
  [[nodiscard]] uint32_t fan_count() const { return record_->fan_count; }
  // Of positive length: the side on which a point is, not how far, may be asked of it.
  [[nodiscard]] Vec3<Real> normal() const {
    return {Real(record_->normal[0]), Real(record_->normal[1]), Real(record_->normal[2])};
  }
  // More than FDCG_BUSY_FAN entries: it has a tree.
  [[nodiscard]] bool is_busy() const { return record_->flags >> FDCG_CORNER_TREE_SHIFT != 0; }
  [[nodiscard]] uint32_t first_fan_entry() const { return record_->first_fan; }
  [[nodiscard]] uint32_t first_fan_box() const { return (record_->flags >> FDCG_CORNER_TREE_SHIFT) - 1; }

 private:
  const typename Records<Real>::Corner* record_;
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
  const fdcg_box8* hierarchy;

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

  [[nodiscard]] NodeRef<Real> node(uint32_t index) const { return {*this, index}; }
  [[nodiscard]] ConnectionRef<Real> connection(uint32_t index) const { return {*this, index}; }
  [[nodiscard]] CornerRef<Real> corner(uint32_t index) const { return {*this, index}; }
  [[nodiscard]] Vec3<Real> corner_point(uint32_t index) const { return vec(corners[index].point); }

  [[nodiscard]] Edge<Real> edge(uint32_t connection_index) const {
    const auto& record = connections[connection_index];
    return {corner_point(record.corner[0]), vec(record.edge), -(record.end_offset[0] + record.end_offset[1])};
  }
  // The same, where a node that the connection belongs to is at hand.
  [[nodiscard]] Edge<Real> edge(NodeRef<Real> node, uint32_t k) const { return edge(node.connection(k)); }

  // Calls visit(FanEntry) for each entry of an ordinary corner's fan, counter-clockwise seen from outside.
  template <class Visit>
  void for_each_in_fan(CornerRef<Real> corner, Visit&& visit) const {
    for (uint32_t i = 0; i < corner.fan_count(); ++i)
      visit(fan_entry(corner, i));
  }
  // Entry i of a busy corner.
  [[nodiscard]] FanEntry fan_entry(CornerRef<Real> corner, uint32_t i) const {
    const uint32_t link = fans[corner.first_fan_entry() + i], end = link & 1;
    const auto& record = connections[link >> 1];
    return {link >> 1, end, record.node[end], record.side[end]};
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
[[gnu::noinline]] int exact_side_sign(const GraphView<Real>& graph, NodeRef<Real> node, Vec3<Real> x, uint32_t* work_left) {
  Vec3<double> corner[3];
  for (uint32_t k = 0; k < 3; ++k)
    corner[k] = widen(graph.corner_point(node.corner(k)));
  return orient3d_sign(corner[0], corner[1], corner[2], widen(x), work_left);
}

// side(x) of the contact model: the distance of x from the face's plane, with its exact sign where the face is exactly planar.
// `bound` is plane_rounding_bound of x. One expression wherever it is asked, so that no two rules disagree. An exact sign
// spends from *work_left; null: not counted.
template <class Real>
[[gnu::always_inline]] inline Real side_of(const GraphView<Real>& graph, NodeRef<Real> node, Vec3<Real> x, Real bound,
                                           uint32_t* work_left) {
  const Real distance = node.plane().distance(x);
  if (absolute(distance) > bound || node.is_inexact()) return distance;
  const int sign = exact_side_sign(graph, node, x, work_left);
  if (sign == 0) return 0;
  if (sign > 0) return distance > 0 ? distance : RealLimits<Real>::kTiny;
  return distance < 0 ? distance : -RealLimits<Real>::kTiny;
}

}  // namespace fdcg
