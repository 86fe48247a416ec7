// SPDX-License-Identifier: Apache-2.0
// A graph with its records typed (contact-model GRAPH-1): what the step reads, and the few expressions that every rule shares.
// Rules see nodes, connections, edges and corners; where their numbers lie in the file, and which of them are derived, only
// this file decides.
//
// A view is a template over the geometry (rigid_geometry.hpp), and all that looks at a graph is one over the same: NodeRef,
// Walk and the rules of the step.
#pragma once

#include "base/config.hpp"
#include "base/mutation.hpp"
#include "exact/exact_orient.hpp"
#include "fdcg/fdcg.h"
#include "graph/box_tree.hpp"
#include "graph/rigid_geometry.hpp"
#include "graph/tolerances.hpp"
#include "shared/derive.hpp"
#include "shared/vec.hpp"

namespace fdcg {
template <class Geometry>
struct GraphView;

// One node, by value: two pointers. `k` counts its sides from 0, in winding order.
template <class Geometry>
class NodeRef {
  using Real = typename Geometry::Real;
  using Key = typename Geometry::NodeKey;
  using Record = typename Records<Real>::Node;
  using StoredPlane = typename Geometry::StoredPlane;

 public:
  NodeRef(const GraphView<Geometry>& graph, const unsigned char* block, uint32_t index)
      : graph_(&graph), block_(block), key_(index) {}

  [[nodiscard]] uint32_t side_count() const { return record().side_count; }
  // The graph's, which bounds the rounding of what is stored of a node.
  [[nodiscard]] Real extent() const { return static_cast<Real>(graph_->header()->extent); }
  // Its corners lie off its plane, by up to header.max_deviation (contact-model GRAPH-4).
  [[nodiscard]] bool is_inexact() const { return FDCG_WITH_INEXACT_NODES && (up_to_date().flags & FDCG_NODE_INEXACT) != 0; }
  [[nodiscard]] uint16_t flags() const { return up_to_date().flags; }
  [[nodiscard]] Vec3<Real> normal() const { return vec(up_to_date().plane.normal); }
  [[nodiscard]] FDCG_HOT StoredPlane plane() const { return given(up_to_date().plane, FDCG_MUTANT("planes-shifted")); }
  // Of an exactly planar node: the first three span its plane.
  [[nodiscard]] uint32_t spanning_corner(uint32_t k) const { return graph_->spanning_corner(*this, k); }

  [[nodiscard]] const fdcg_side& side(uint32_t k) const {
    return reinterpret_cast<const fdcg_side*>(block_ + offsetof(Record, sides))[k];
  }
  [[nodiscard]] uint32_t connection(uint32_t k) const { return side(k).link >> 1; }
  // Which of the connection's nodes this one is: 0 or 1.
  [[nodiscard]] uint32_t which(uint32_t k) const { return side(k).link & 1; }
  // The corner at which side k starts.
  [[nodiscard]] uint32_t corner(uint32_t k) const { return side(k).corner; }
  // The corner at which side k of its loop starts, if k may be one past the last.
  [[nodiscard]] uint32_t corner_before(uint32_t k) const { return corner(k & (0u - uint32_t{k < side_count()})); }
  // The node beyond side k, or FDCG_NONE.
  [[nodiscard]] uint32_t across(uint32_t k) const { return side(k).across; }
  // The side with this link, or side_count(): what the connection's record says, without its cache line. Of the first three
  // without a branch, which could not be predicted.
  [[nodiscard]] uint32_t side_of_link(uint32_t link) const {
    const auto differs = [&](uint32_t k) {
      const uint32_t other = side(k).link ^ link;
      return (other | (0u - other)) >> 31;
    };
    uint32_t k = (1 - differs(1)) + 2 * (1 - differs(2));
    if (side(k).link == link) return k;
    for (k = 3; k < side_count() && side(k).link != link; ++k) {
    }
    return k;
  }
  // Without a branch: which side a god-object crosses cannot be predicted.
  [[nodiscard]] uint32_t previous(uint32_t k) const { return k - 1 + (side_count() & (0u - uint32_t{k == 0})); }
  [[nodiscard]] uint32_t next(uint32_t k) const { return (k + 1) & (0u - uint32_t{k + 1 < side_count()}); }

  // voronoi_plane() where the graph has them.
  [[nodiscard]] FDCG_HOT StoredPlane stored_plane(uint32_t k) const {
    const auto* const planes = reinterpret_cast<const typename Records<Real>::Plane*>(block_ + planes_at<Real>(side_count()));
    return given(planes[k], FDCG_MUTANT("rims-shifted"));
  }
  // Through side k's edge, normal pointing out of the face: m_0 = e x n_0, m_1 = n_1 x e (contact-model GRAPH-3).
  [[nodiscard]] FDCG_HOT decltype(auto) voronoi_plane(uint32_t k) const {
    if constexpr (Geometry::kHasPlanes) {
      return stored_plane(k);
    } else {
      if (__builtin_expect(graph_->has_planes(), true)) return Plane<Real>(stored_plane(k));
      Plane<Real> derived;
      derive_plane(k, &derived);
      return derived;
    }
  }

  // The first side inside of whose Voronoi plane a point may not be by more than `bound`; those before it surely hold it, which
  // is cheaper to test than the plane itself where planes are derived for a mesh that moves.
  [[nodiscard]] uint32_t first_doubtful(Vec3<Real> x, Real bound) const { return graph_->first_doubtful(*this, x, bound); }

  [[nodiscard]] const unsigned char* block() const { return block_; }
  [[nodiscard]] const GraphView<Geometry>& graph() const { return *graph_; }
  [[nodiscard]] Key key() const { return key_; }

 private:
  [[nodiscard]] FDCG_HOT StoredPlane given(const typename Records<Real>::Plane& plane, bool is_shifted) const {
    if constexpr (Geometry::kGivesPlanesInPlace) {
      static_assert(sizeof plane == sizeof(Plane<Real>) && offsetof(Plane<Real>, offset) == sizeof plane.normal);
      return *reinterpret_cast<const Plane<Real>*>(&plane);
    } else {
      return {vec(plane.normal), is_shifted ? plane.offset + fault_shift() : plane.offset};
    }
  }
  // Out of line: every rule reads planes, and each would inline a copy. Not as a return value: four floats are returned two to
  // a register, through memory, which stalls.
  [[gnu::noinline]] void derive_plane(uint32_t k, Plane<Real>* plane) const {
    const Edge<Real> edge = graph_->edge(*this, k);
    if (!graph_->has_voronoi_plane(edge, normal())) {
      *plane = {};
      return;
    }
    *plane = derive_voronoi_plane(edge.start, edge.direction, normal(), which(k));
  }
  [[nodiscard]] const Record& record() const { return *reinterpret_cast<const Record*>(block_); }
  // Of faults that tests plant (base/mutation.hpp).
  [[nodiscard]] Real fault_shift() const { return 512 * RealLimits<Real>::kEpsilon * extent(); }
  // The record with its plane.
  [[nodiscard]] const Record& up_to_date() const {
    graph_->bring_up_to_date(key_);
    return record();
  }

  const GraphView<Geometry>* graph_;
  const unsigned char* block_;
  [[no_unique_address]] Key key_;
};

// One connection, by value.
template <class Geometry>
class ConnectionRef {
 public:
  ConnectionRef(const GraphView<Geometry>& graph, uint32_t index) : graph_(&graph), record_(&graph.connections()[index]) {}

  // fdcg_connection_type
  [[nodiscard]] uint8_t type() const {
    const uint8_t type = graph_->type_of(*record_);
    if (FDCG_MUTANT("all-convex") && type == FDCG_CONCAVE) return FDCG_CONVEX;
    if (FDCG_MUTANT("all-concave") && type == FDCG_CONVEX) return FDCG_CONCAVE;
    return type;
  }
  // k = 1: FDCG_NONE on a boundary.
  [[nodiscard]] uint32_t node(uint32_t k) const { return k == 0 ? record_->node : first().across(record_->side[0]); }
  [[nodiscard]] uint32_t side(uint32_t k) const { return record_->side[k]; }  // which side of node(k) this is
  [[nodiscard]] uint32_t corner(uint32_t end) const {
    return first().corner(end == 0 ? record_->side[0] : first().next(record_->side[0]));
  }

 private:
  [[nodiscard]] NodeRef<Geometry> first() const { return graph_->node(record_->node); }

  const GraphView<Geometry>* graph_;
  const fdcg_connection* record_;
};

// One entry of a corner's fan: a connection that leaves the corner from its end `end`, and the node to its left (FDCG_NONE
// where an open fan ends), of which it is the side `outgoing`.
struct FanEntry {
  uint32_t connection, end, node, outgoing;
};

template <class Geometry>
class CornerRef {
  using Real = typename Geometry::Real;

 public:
  CornerRef(const GraphView<Geometry>& graph, uint32_t index) : graph_(&graph), record_(&graph.corners()[index]) {}

  [[nodiscard]] decltype(auto) point() const { return graph_->point_of(*record_); }
  [[nodiscard]] bool is_open() const { return (record_->fan & FDCG_CORNER_OPEN) != 0; }
  [[nodiscard]] uint32_t fan_count() const { return is_busy() ? busy().fan_count : walked_count(); }
  // Of about unit length: good for the side on which a point is, not for its distance.
  [[nodiscard]] Vec3<Real> normal() const {
    constexpr Real kUnit = Real(1) / FDCG_NORMAL_SCALE;
    graph_->bring_normal_up_to_date(*record_);
    return Vec3<Real>{Real(record_->normal[0]), Real(record_->normal[1]), Real(record_->normal[2])} * kUnit;
  }
  // Its fan is stored: more than FDCG_BUSY_FAN entries.
  [[nodiscard]] bool is_busy() const { return FDCG_WITH_BUSY_CORNERS && walked_count() == 0; }
  // Of a busy corner. Without a tree, which no file has, first_box is FDCG_NONE.
  [[nodiscard]] const fdcg_busy_corner& busy() const { return graph_->busy_corners()[record_->first]; }
  // Of an ordinary corner: the node and its side with which the fan starts, and how many entries it has.
  [[nodiscard]] uint32_t first_node() const { return record_->first; }
  [[nodiscard]] uint32_t first_side() const { return record_->side; }
  [[nodiscard]] uint32_t walked_count() const { return record_->fan & ~FDCG_CORNER_OPEN; }

 private:
  const GraphView<Geometry>* graph_;
  const typename Records<Real>::Corner* record_;
};

template <class Geometry>
struct GraphView : Geometry {
  using Real = typename Geometry::Real;

  static constexpr uint32_t kLineBytes = 64;  // of most machines' caches; a wrong size costs prefetches, nothing else
  static constexpr uint32_t kPrefetchedSides = 3;

  explicit GraphView(const fdcg_graph& graph) : Geometry(graph) {}

  // How far a node's corners may lie off its plane.
  [[nodiscard]] double max_deviation() const { return FDCG_WITH_INEXACT_NODES ? this->header()->max_deviation : 0; }
  [[nodiscard]] bool has_inexact_nodes() const { return max_deviation() > 0; }

  [[nodiscard]] NodeRef<Geometry> node(uint32_t index) const { return {*this, block_of(index), index}; }
  [[nodiscard]] ConnectionRef<Geometry> connection(uint32_t index) const { return {*this, index}; }
  [[nodiscard]] CornerRef<Geometry> corner(uint32_t index) const { return {*this, index}; }
  // Side k of a node, from the connection's corner 0 to its corner 1, whichever way the node's loop runs.
  void read_edge(NodeRef<Geometry> node, uint32_t k, Edge<Real>* edge) const {
    const uint32_t end[2] = {node.corner(k), node.corner(node.next(k))};
    this->read_edge_between(node.connection(k), end[node.which(k)], end[1 - node.which(k)], edge);
  }
  void read_edge(uint32_t connection_index, Edge<Real>* edge) const {
    const fdcg_connection& record = this->connections()[connection_index];
    read_edge(node(record.node), record.side[0], edge);
  }
  // A connection's direction: where edges are stored, without a look at its ends.
  [[nodiscard]] Vec3<Real> direction(uint32_t connection_index) const {
    if (this->has_edges()) return vec(this->edges()[connection_index].direction);
    return edge(connection_index).direction;
  }
  template <class... Where>
  [[nodiscard]] Edge<Real> edge(Where... where) const {
    Edge<Real> edge;
    read_edge(where..., &edge);
    return edge;
  }

  // Prefetches the records of side k's edge: connection, direction and a corner.
  FDCG_HOT void prefetch_edge(NodeRef<Geometry> here, uint32_t k) const {
    __builtin_prefetch(&this->connections()[here.connection(k)]);
    __builtin_prefetch(&this->corners()[here.corner(k)]);
    if (this->has_edges()) __builtin_prefetch(&this->edges()[here.connection(k)]);
  }
  // Prefetches what lies at and beyond side k: all that the step reads when the god-object crosses it. The addresses are in
  // this node's block, so that the cache misses of one crossing overlap. Inlined by force: GCC 12 treats a function that only
  // prefetches as one without effect, and drops its calls.
  FDCG_HOT void prefetch_crossing(NodeRef<Geometry> here, uint32_t k) const {
    prefetch_edge(here, k);
    if (here.across(k) == FDCG_NONE) return;
    const unsigned char* const block = node(here.across(k)).block();
    const uint32_t bytes = node_bytes<Real>(kPrefetchedSides, this->has_planes());
    for (uint32_t at = 0; at < bytes; at += kLineBytes)
      __builtin_prefetch(block + at);
  }
  // The same for every side of a triangle; for a larger face the side of the crossing cannot be predicted.
  FDCG_HOT void prefetch_around(NodeRef<Geometry> here) const {
    for (uint32_t k = 0; k < kPrefetchedSides; ++k)
      prefetch_crossing(here, k);
  }
  // With stored planes and edges, as files are by default.
  [[nodiscard]] bool is_plain() const { return this->has_edges() && this->has_planes(); }
  // Of one side in a plain graph what a crossing reads: the node beyond alone (face.hpp, goes_onto_side). Without a branch:
  // what lies across a border is node 0 here.
  FDCG_HOT void prefetch_plainly(const fdcg_side& side) const {
    constexpr uint32_t kBytes = node_bytes<Real>(kPrefetchedSides, true);
    const unsigned char* const block = node(side.across == FDCG_NONE ? 0 : side.across).block();
#pragma GCC unroll 8
    for (uint32_t at = 0; at < kBytes; at += kLineBytes)
      __builtin_prefetch(block + at);
    __builtin_prefetch(block + kBytes - 1);
  }

  // Whether many of its edges are concave, so that edges keep the god-object often.
  [[nodiscard]] bool keeps_on_edges() const {
    return this->header()->connection_type_count[FDCG_CONCAVE] > this->header()->connection_count / 8;
  }
  // The same of all sides of a triangle in a plain graph. One of them is where the god-object came in, and at hand already; to
  // leave it out would be to wait until it is known which. Without the empty statement GCC 12 would drop the calls.
  [[gnu::noinline]] void prefetch_neighbours_of(uint32_t n) const {
    const NodeRef<Geometry> here = node(n);
#pragma GCC unroll 3
    for (uint32_t k = 0; k < kPrefetchedSides; ++k)
      prefetch_plainly(here.side(k));
    if (keeps_on_edges()) {
#pragma GCC unroll 3
      for (uint32_t k = 0; k < kPrefetchedSides; ++k)
        prefetch_edge(here, k);
    }
    __asm__ volatile("");
  }

  // The same around each neighbour, but for one around which it has been done: `from`, or FDCG_NONE. They are read for it, so
  // they should have been prefetched some time before.
  FDCG_HOT void prefetch_around_neighbours_of(uint32_t n, uint32_t from) const {
    const NodeRef<Geometry> here = node(n);
    for (uint32_t k = 0; k < kPrefetchedSides; ++k) {
      const uint32_t across = here.across(k);
      if (across != from && across != FDCG_NONE) prefetch_neighbours_of(across);
    }
  }

  // Whether its data may be out of a processor's last cache.
  [[nodiscard]] bool is_large() const {
    constexpr uint64_t kLarge = 64'000'000;  // bytes
    return this->header()->file_bytes > kLarge;
  }

  // Calls visit(FanEntry) for each entry of a corner's fan, counter-clockwise seen from outside. Busy corners have long ones.
  template <class Visit>
  void for_each_in_fan(CornerRef<Geometry> corner, Visit&& visit) const {
    if (corner.is_busy()) {
      for (uint32_t i = 0; i < corner.fan_count(); ++i)
        visit(fan_entry(corner, i));
      return;
    }
    FanEntry entry;
    read_fan_entry(corner.first_node(), corner.first_side(), &entry);
    for (uint32_t left = corner.walked_count(); left > 0; --left) {
      visit(entry);
      read_next_in_fan(&entry);
      if (entry.node == FDCG_NONE) return visit(entry);
    }
  }
  // The entry that leaves its corner by side k of a node, and the one after that.
  void read_fan_entry(uint32_t n, uint32_t k, FanEntry* entry) const {
    const NodeRef<Geometry> here = node(n);
    *entry = {here.connection(k), here.which(k), n, k};
  }
  FDCG_ONE_COPY void read_next_in_fan(FanEntry* entry) const {
    const NodeRef<Geometry> here = node(entry->node);
    const uint32_t incoming = here.previous(entry->outgoing), beyond = here.across(incoming);
    if (beyond == FDCG_NONE) {
      *entry = {here.connection(incoming), 1 - here.which(incoming), FDCG_NONE, 0};
    } else {
      read_fan_entry(beyond, this->connections()[here.connection(incoming)].side[1 - here.which(incoming)], entry);
    }
  }
  // Where a node's record begins.
  [[nodiscard]] FDCG_HOT const unsigned char* block_of(uint32_t index) const {
    const size_t at =
        this->node_offsets() == nullptr ? index * this->block_bytes() : this->node_offsets()[index] * sizeof(Real);
    return this->nodes() + at;
  }
  // Entry i of a busy corner.
  [[nodiscard]] FanEntry fan_entry(CornerRef<Geometry> corner, uint32_t i) const {
    const uint32_t link = this->fans()[corner.busy().first_fan + i], end = link & 1;
    const ConnectionRef<Geometry> entry = connection(link >> 1);
    return {link >> 1, end, entry.node(end), entry.side(end)};
  }
};

// Of a graph as it is.
template <class Real>
using RigidView = GraphView<RigidGeometry<Real>>;

// How far a place is in front of a node's plane, and beyond that of its side k.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_ONE_COPY Real distance_from(NodeRef<Geometry> node, const Vec3<Real>& x) {
  return node.plane().distance(x);
}
template <class Geometry, class Real = typename Geometry::Real>
FDCG_ONE_COPY Real distance_beyond(NodeRef<Geometry> node, uint32_t k, const Vec3<Real>& x) {
  return node.voronoi_plane(k).distance(x);
}

// The sign of x against the plane through the first three corners of an exactly planar node.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] int exact_side_sign(const GraphView<Geometry>& graph, NodeRef<Geometry> node, const Vec3<Real>& x,
                                      uint32_t* work_left) {
  Vec3<Real> corner[3];
  for (uint32_t k = 0; k < 3; ++k) {
    const Vec3<Real> v = graph.corner_point(node.spanning_corner(k));
    corner[k] = by_parts(v);
    if (v.x == x.x && v.y == x.y && v.z == x.z) return 0;  // at an apex of 10^4 faces worth 10^4 exact signs
  }
  return orient3d_sign(corner[0], corner[1], corner[2], x, work_left);
}

// side(x) of contact-model SIDE-1: the distance of x from the face's plane, with its exact sign where the face is exactly
// planar. `bound` is plane_rounding_bound of x. One expression wherever it is asked, so that no two rules disagree. An exact
// sign spends from *work_left; null: not counted.
template <class Geometry, class Real = typename Geometry::Real>
FDCG_HOT Real side_of(const GraphView<Geometry>& graph, NodeRef<Geometry> node, const Vec3<Real>& x, Real bound,
                      uint32_t* work_left) {
  const Real distance = distance_from(node, x);
  if (absolute(distance) > bound || node.is_inexact()) return distance;
  const int sign = exact_side_sign(graph, node, by_parts(x), work_left);
  if (sign == 0) return 0;
  if (sign > 0) return distance > 0 ? distance : RealLimits<Real>::kSignOnly;
  return distance < 0 ? distance : -RealLimits<Real>::kSignOnly;
}

}  // namespace fdcg
