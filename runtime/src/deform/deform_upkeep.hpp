// SPDX-License-Identifier: Apache-2.0
// The memory of a deformable mesh, and the update of all that depends on its corners' places:
//
//   fdcg_deform | node blocks | corners | Place[corners] | log of one tick[corners] | of the next | connections | busy corners
//   | hierarchy | stale[leaves] | loose[records] | leaf_first[corners + 1] | leaves of corners
//
// A corner that moves leaves marks (deform.cpp): its triangles are stale, the boxes around them have grown and are loose. The
// geometry (deformable_geometry.hpp) updates stale data before it returns a number. Voronoi planes, edges, types and corner
// normals are derived on each use and never stored, so they cannot be stale. The corners' records have the positions of the
// last full update; they are for readers of the graph through the API.
#pragma once

#include "deform/deform_watch.hpp"
#include "exact/exact_orient.hpp"
#include "fdcg/deform.h"
#include "graph/record_types.hpp"
#include "shared/face_plane.hpp"

struct fdcg_deform {
  fdcg_graph graph;  // first member: the step gets a pointer to the graph, which deform_of casts back
  fdcg_header header;
  unsigned char* nodes;
  void* corners;
  void* places;
  void* logs[2];  // where corners were that have moved: of even ticks, of odd ones
  fdcg_connection* connections;
  fdcg_box8* boxes;
  uint8_t* stale;        // by leaf, a bit for each node of it
  uint8_t* loose;        // by record, a bit for each box that may be larger than it must
  uint32_t* tight_tick;  // by record: in which boxes were last made tight; the tick's lower half
  uint32_t* leaf_first;  // corner c is in the leaves leaf_first[c] .. leaf_first[c + 1] - 1
  uint32_t* leaves;      // leaf << FDCG_LEAF_NODES | a bit for each of its nodes that the corner belongs to
  fdcg::BoxTree tree;
  uint64_t tick;       // counts the motions that steps have begun; cannot overflow in practice
  uint32_t has_moved;  // how many corners, since the last step. They have the number of the next tick
  uint32_t node_bytes;
  uint32_t upkeep_left;  // of a step's upkeep, in units of work.hpp
  uint32_t reserved;
  double per_tree_unit;
  double travel;           // the sum over all ticks of the largest way of a corner, rounded up; local
  double tick_travel;      // of the present tick
  double way2;             // the largest way of the tick to come, squared
  double low[3], high[3];  // local: where corners may be moved
  fdcg::WatchedBalls watched;
};

namespace fdcg {

// Where a corner is, when it last moved, and where it may go without leaving new marks: all that a move looks at, in a line of
// the cache. While `is_marked`, its triangles are stale, its leaves' boxes are loose, and all of them hold all that lies
// between `low` and `high`. Whatever removes a mark, or makes a box smaller, resets it: so a corner that no step uses
// is marked once, however often it moves.
template <class Real>
struct alignas(64) Place {
  Real point[3];
  uint32_t is_marked;
  uint32_t logged;  // where it was before that tick: in the tick's log
  uint64_t tick;
  float low[3], high[3];  // tree units
};
static_assert(sizeof(Place<double>) == 64 && sizeof(Place<float>) == 64);

// An entry of a tick's log. Logs are as long as the mesh has corners, and none is in one twice.
template <class Real>
struct Was {
  Real point[3];
};

// The least float that is not below x.
inline float float_above(double x) {
  const auto f = static_cast<float>(x);
  if (!(static_cast<double>(f) < x)) return f;
  const uint32_t bits = __builtin_bit_cast(uint32_t, f);
  return __builtin_bit_cast(float, f < 0 ? bits - 1 : bits + 1);
}

inline fdcg_deform& deform_of(const fdcg_graph& graph) {
  return *reinterpret_cast<fdcg_deform*>(const_cast<fdcg_graph*>(&graph));
}

// derive_edge, of corners that may be one place too: then in some direction, and of no length.
template <class Real>
inline Edge<Real> derive_edge_or_point(Vec3<Real> corner0, Vec3<Real> corner1) {
  const bool is_point = corner0.x == corner1.x && corner0.y == corner1.y && corner0.z == corner1.z;
  return is_point ? Edge<Real>{corner0, {1, 0, 0}, 0} : derive_edge(corner0, corner1);
}

// Whether a side has no Voronoi plane: it is a point, or stands on the plane that a triangle without area has taken from a
// neighbour.
template <class Real>
inline bool bounds_nothing(Vec3<Real> direction, Vec3<Real> normal, Real length) {
  return length == 0 || norm1(cross(direction, normal)) == 0;
}

// Whether a triangle's corners are in one line, up to rounding error: its normal has no meaning, and may be reversed.
template <class Real>
FDCG_HOT bool is_line(Vec3<double> a, Vec3<double> b, Vec3<double> c, double extent) {
  constexpr double kRounding = 8 * double{RealLimits<Real>::kEpsilon};
  const Vec3<double> u = b - a, v = c - a, doubled_area = cross(u, v);
  const double least = kRounding * extent;
  return !(dot(doubled_area, doubled_area) > least * least * larger(dot(u, u), dot(v, v)));
}

template <class Real>
class Upkeep {
  using Node = typename Records<Real>::Node;
  using Corner = typename Records<Real>::Corner;

 public:
  explicit Upkeep(fdcg_deform& deform) : d_(&deform) {}

  [[nodiscard]] fdcg_deform& deform() const { return *d_; }
  [[nodiscard]] Node& node(uint32_t n) const {
    return *reinterpret_cast<Node*>(d_->nodes + n * uint64_t{node_bytes<Real>(3, false)});
  }
  [[nodiscard]] Corner& corner(uint32_t c) const { return static_cast<Corner*>(d_->corners)[c]; }
  [[nodiscard]] Place<Real>& place(uint32_t c) const { return static_cast<Place<Real>*>(d_->places)[c]; }
  [[nodiscard]] Vec3<Real> point(uint32_t c) const { return vec(place(c).point); }
  // Where a corner was before the tick that it last moved in; of this tick or the next, else nothing is known.
  [[nodiscard]] Was<Real>& was(const Place<Real>& place) const {
    return static_cast<Was<Real>*>(d_->logs[place.tick & 1])[place.logged];
  }
  // Where the corner was before the present tick.
  [[nodiscard]] Vec3<Real> old_point(uint32_t c) const { return has_moved(c) ? vec(was(place(c)).point) : point(c); }
  [[nodiscard]] bool has_moved(uint32_t c) const { return place(c).tick == d_->tick; }

  // ---- nodes

  void bring_up_to_date(uint32_t n) const {
    if (__builtin_expect((d_->stale[n / FDCG_LEAF_NODES] >> n % FDCG_LEAF_NODES & 1) != 0, false)) compute_node(n);
  }
  // Its corners are in one line: it has the plane of a neighbour.
  [[nodiscard]] bool is_sliver(uint32_t n) const {
    bring_up_to_date(n);
    return (node(n).flags & kSliver) != 0;
  }
  [[nodiscard]] uint32_t spanning_corner(uint32_t n, uint32_t k) const {
    if (__builtin_expect((node(n).flags & kSliver) != 0, false)) n = plane_lender(n).node;
    return node(n).sides[k].corner;
  }
  // The side of a sliver that holds the other two.
  [[nodiscard]] uint32_t longest_side(uint32_t n) const { return longest_side(n, kAllSides); }

  // ---- connections, corner normals

  [[nodiscard]] uint8_t type(uint32_t connection) const;
  void bring_normal_up_to_date(uint32_t c) const;

  // ---- hierarchy

  // Makes those of a record's boxes tight that are loose and in `lanes`; where they are again, not before some ticks have
  // passed. False: nothing was done.
  [[nodiscard]] bool has_tightened(int level, uint32_t record, uint32_t lanes) const {
    constexpr uint32_t kTicksBetween = 8;
    const uint32_t at = d_->tree.first[level] + record, due = d_->loose[at] & lanes;
    const auto now = static_cast<uint32_t>(d_->tick);
    if (__builtin_expect(due == 0, true) || now - d_->tight_tick[at] < kTicksBetween) return false;
    make_tight(level, record, due);
    d_->tight_tick[at] = now;
    return true;
  }
  // Marks what depends on a corner's place; it has moved by `way`, in tree units.
  void mark(uint32_t c, Vec3<double> way) const;
  // Makes a level's box, and those around it, hold more, and marks them as loose. Level 0: a leaf's.
  void hold(int level, uint32_t index, const TreeBox& box) const;
  [[nodiscard]] Vec3<double> in_tree(Vec3<Real> p) const { return widen(p) * d_->per_tree_unit; }
  void make_tight(int level, uint32_t record, uint32_t due) const;
  [[nodiscard]] TreeBox leaf_box(uint32_t leaf, bool* may_shrink) const;

 private:
  static constexpr uint16_t kSliver = 0x8000;  // in a node's flags
  static constexpr int kMostHops = 16;         // from sliver to sliver

  // The node whose plane a sliver uses; FDCG_NONE: none. `side`: the side by which the search entered it.
  struct Lender {
    uint32_t node, side;
  };

  void compute_node(uint32_t n) const;
  void compute_sliver(uint32_t n) const;
  [[nodiscard]] Lender plane_lender(uint32_t n) const;
  static constexpr uint32_t kAllSides = 7;  // a bit each
  // Of a set of sides; FDCG_NONE where it is empty.
  [[nodiscard]] uint32_t longest_side(uint32_t n, uint32_t sides) const;
  [[nodiscard]] bool is_line(uint32_t n) const;
  // A corner of the node, or of the neighbour whose plane it uses, that is off side k's line.
  [[nodiscard]] uint32_t apex(uint32_t n, uint32_t k) const;
  [[nodiscard]] uint32_t side_across(uint32_t n, uint32_t k) const {
    const fdcg_side& side = node(n).sides[k];
    return d_->connections[side.link >> 1].side[1 - (side.link & 1)];
  }
  [[nodiscard]] Vec3<double> leaving(uint32_t n, uint32_t k) const;

  fdcg_deform* d_;
};

extern template class Upkeep<double>;
extern template class Upkeep<float>;

}  // namespace fdcg
