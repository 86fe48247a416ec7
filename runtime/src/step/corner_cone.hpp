// SPDX-License-Identifier: Apache-2.0
// On which side of a corner's faces the HIP lies (contact-model CORNER-4): exactly, as a question of its own. The feature that
// is nearest would tell it too, but which one that is can be a matter of rounding.
#pragma once

#include "graph/implicit_tree.hpp"
#include "step/edge.hpp"
#include "step/walk.hpp"

namespace fdcg {

// What one search of a busy corner's tree may spend; what it has found by then is taken. Cones, crowns and needles of 10,000
// sides take 100 to 300.
inline constexpr uint32_t kFanSearchWork = 600;

// So many edges of a busy corner are looked at for one to which a way from the HIP is told by few faces.
inline constexpr uint32_t kEdgesAround = 4;

// The way from the HIP to a point on one of the corner's edges, and the faces at the corner, each as if it went on for ever.
// How the way arrives at the edge, out of the solid or through it, is told by the two faces there (EDGE-1). Before, it changes
// sides with every other face that it crosses.
//
// All signs are those of the corners against the plane of the way. A corner that lies in the plane is taken for one beside it,
// always on the same side: that is another cone, and as good a one, since the HIP is not on its surface.
template <class Geometry>
class WayToEdge {
  using Real = typename Geometry::Real;

 public:
  WayToEdge(Walk<Geometry>& walk, CornerRef<Geometry> corner, const FanEntry& edge)
      : walk_(walk),
        corner_(corner.point()),
        target_(far_end(walk.graph, edge)),
        target_bound_(plane_rounding_bound(walk.graph, target_)) {
    const ConnectionRef<Geometry> connection = walk.graph.connection(edge.connection);
    Real sides[2];
    for (uint32_t k = 0; k < 2; ++k) {
      beside_[k] = connection.node(k);
      sides[k] = side(walk.graph.node(beside_[k]));
    }
    is_outside_ = is_free_of_edge(connection.type(), sides[0] < 0, sides[1] < 0);
    // The other corner of the face to the left, so that a HIP on that face's plane is in front of it; on both planes, of the
    // one on whose side of the edge it is.
    tie_ = sides[edge.end] == 0 && (sides[1 - edge.end] != 0 || turns_left(target_, walk.hip, walk.graph.node(edge.node))) ? -1
                                                                                                                           : 1;
  }

  // A face of the fan. Call for each, or for all that the plane of the way can meet.
  [[gnu::noinline, gnu::cold]] void pass(const FanEntry& entry) {
    if (entry.node == FDCG_NONE) return;
    const NodeRef<Geometry> node = walk_.graph.node(entry.node);
    const bool is_beside = entry.node == beside_[0] || entry.node == beside_[1];
    const uint32_t left = node.corner(node.next(entry.outgoing)), right = node.corner(node.previous(entry.outgoing));
    const int from = is_beside ? 0 : sign_of(left), to = is_beside ? 0 : sign_of(right);
    if (from == to && from != 0) return;
    const Real hip_side = side(node);
    if (hip_side == 0) is_on_surface_ = is_on_surface_ || is_in_sector(node, left, right);
    if (hip_side == 0 || is_beside) return;
    if (from == 0 && to == 0 ? !is_far_sided(node) : beside(from) == beside(to)) return;
    if (from != to && beside(from) != (hip_side > 0 ? 1 : -1)) return;  // what is met is the face's other side of the corner
    const Real target_side = side(node, target_, target_bound_);
    if (node.is_inexact() && absolute(target_side) <= walk_.graph.max_deviation() + target_bound_) return;  // on it
    if (hip_side > 0 ? target_side < 0 : target_side > 0) is_outside_ = !is_outside_;
  }

  [[nodiscard]] bool is_outside() const { return is_outside_ || is_on_surface_; }
  [[nodiscard]] uint32_t work() const { return kMuch - work_left_; }
  [[nodiscard]] Vec3<Real> target() const { return target_; }  // the edge's other end

 private:
  static Vec3<Real> far_end(const GraphView<Geometry>& graph, const FanEntry& edge) {
    return graph.corner_point(graph.connection(edge.connection).corner(1 - edge.end));
  }
  // Two sides in one line with the corner, and in the plane of the way: the face is all on the other side of it than corners
  // in it are taken to be.
  [[gnu::noinline, gnu::cold]] bool is_far_sided(NodeRef<Geometry> node) {
    for (uint32_t k = 0; k < node.side_count() && node.side_count() > 3; ++k) {
      const int sign = sign_of(node.corner(k));
      if (sign != 0) return sign != tie_;
    }
    return false;
  }
  // Of a HIP on the face's plane: between the face's sides at the corner, or on one.
  bool is_in_sector(NodeRef<Geometry> node, uint32_t left, uint32_t right) {
    return turns_left(walk_.graph.corner_point(left), walk_.hip, node) &&
           turns_left(walk_.hip, walk_.graph.corner_point(right), node);
  }
  // Whether b is to the left of a about the corner, seen from the front of a node that they lie on; or in line with it.
  [[gnu::noinline, gnu::cold]] bool turns_left(const Vec3<Real>& a, const Vec3<Real>& b, NodeRef<Geometry> node) {
    const Vec3<double> corner = widen(corner_), above = corner + widen(node.normal()) * walk_.graph.header()->extent;
    return orient3d_sign(corner, widen(a), widen(b), above, &work_left_) >= 0;
  }
  [[nodiscard]] int beside(int sign) const { return sign == 0 ? tie_ : sign; }
  // Kept for the last: the next face of the fan asks for it again.
  [[gnu::noinline, gnu::cold]] int sign_of(uint32_t corner) {
    if (corner != last_) {
      last_ = corner;
      spend(&work_left_, kFanSignWork);
      last_sign_ = orient3d_sign(walk_.hip, corner_, target_, walk_.graph.corner_point(corner), &work_left_);
    }
    return last_sign_;
  }

  static constexpr uint32_t kMuch = 1u << 30;

  [[nodiscard]] Real side(NodeRef<Geometry> node) { return side(node, walk_.hip, walk_.hip_bound); }
  [[nodiscard, gnu::noinline, gnu::cold]] Real side(NodeRef<Geometry> node, const Vec3<Real>& x, Real bound) {
    return side_of(walk_.graph, node, x, bound, &work_left_);
  }

  Walk<Geometry>& walk_;
  uint32_t work_left_ = kMuch;
  const Vec3<Real> corner_;
  Vec3<Real> target_;
  Real target_bound_;
  uint32_t beside_[2];
  int tie_;
  bool is_outside_, is_on_surface_ = false;
  uint32_t last_ = FDCG_NONE;
  int last_sign_ = 0;
};

// The faces of a busy corner that the plane of the way can meet: those in boxes of its tree on both sides of the plane. False:
// they are too many.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] bool pass_by_tree(Walk<Geometry>& walk, CornerRef<Geometry> corner, WayToEdge<Geometry>& way) {
  // In double and from the points themselves: of a long body's tip all directions are one but for their last digits.
  const Vec3<double> point = widen(corner.point()), t = widen(walk.hip) - point, along = widen(way.target()) - point;
  const Vec3<double> normal = cross(t, along);
  const double own_rounding = plane_of_way_rounding(t, along);
  if (norm1(normal) <= own_rounding) return true;  // the HIP is beside the edge: nothing lies between
  const double rounding = fan_rounding<Real>(normal) + own_rounding;
  const ImplicitTree layout(corner.fan_count(), FDCG_LEAF_FAN);
  const auto* boxes = walk.graph.fan_boxes() + corner.busy().first_box;
  uint32_t stack[2 * kMaxLevels];  // box * 32 + level
  int waiting = 0;
  const auto push = [&](uint32_t level, uint32_t i) {
    const auto& box = boxes[layout.first[level] + i];
    double radius = rounding;
    for (const auto& axis : box.axis)
      radius += absolute(dot(normal, widen(vec(axis))));
    if (absolute(dot(normal, widen(vec(box.centre)))) <= radius) stack[waiting++] = i << 5 | level;
  };
  push(static_cast<uint32_t>(layout.levels - 1), 0);
  for (uint32_t work = 0; waiting > 0 && work + way.work() < kFanSearchWork;) {
    const uint32_t level = stack[--waiting] & 31, i = stack[waiting] >> 5;
    work += 2 * kFanBoxWork;
    walk.spend(2 * kFanBoxWork);
    if (level > 0) {
      push(level - 1, 2 * i);
      if (2 * i + 1 < layout.size[level - 1]) push(level - 1, 2 * i + 1);
      continue;
    }
    const uint32_t end = (i + 1) * FDCG_LEAF_FAN < corner.fan_count() ? (i + 1) * FDCG_LEAF_FAN : corner.fan_count();
    for (uint32_t k = i * FDCG_LEAF_FAN; k < end; ++k)
      way.pass(walk.graph.fan_entry(corner, k));
  }
  return waiting == 0;
}

// Where the straight way from a corner to the HIP begins. On the surface is outside; `behind_all`: inside, and every feature of
// the corner holds the god-object.
enum class Beginning { outside, inside, behind_all, not_told };

// Of a HIP surely behind the planes of all faces, or in front of all: a way from it to a point of one of them would come
// through others in one direction only, so it comes through none. Not told: neither, a fan that is not closed, faces off their
// planes.
template <class Geometry>
[[gnu::noinline, gnu::cold]] Beginning beside_all_faces(Walk<Geometry>& walk, CornerRef<Geometry> corner) {
  uint32_t behind = 0, in_front = 0, all = 0;
  walk.graph.for_each_in_fan(corner, [&](const FanEntry& entry) {
    ++all;
    if (entry.node == FDCG_NONE || walk.graph.node(entry.node).is_inexact()) return;
    const auto side = distance_from(walk.graph.node(entry.node), walk.hip);
    behind += side < -walk.hip_bound;
    in_front += side > walk.hip_bound;
  });
  walk.spend(kNodeWork * all);
  if (behind == all) return walk.graph.has_inexact_nodes() ? Beginning::inside : Beginning::behind_all;  // EDGE-7
  return in_front == all ? Beginning::outside : Beginning::not_told;
}

// Whether an edge's two faces differ: one of a deformable mesh that is squeezed to a line has a neighbour's plane.
template <class Geometry>
[[nodiscard]] inline bool has_two_faces(const GraphView<Geometry>& graph, const FanEntry& entry) {
  if constexpr (Geometry::kKeepsDirections) {
    return true;
  } else {
    const ConnectionRef<Geometry> connection = graph.connection(entry.connection);
    return connection.type() == FDCG_BOUNDARY || (graph.has_area(connection.node(0)) && graph.has_area(connection.node(1)));
  }
}

// contact-model CORNER-4. Exact, but at corners of faces that lie off their planes. Not told: of an open corner, which has no
// inside, and of a busy one where hundreds of faces lie in one plane with the way.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Beginning beginning_of_way(Walk<Geometry>& walk, CornerRef<Geometry> corner) {
  if (corner.is_open()) return Beginning::not_told;
  const GraphView<Geometry>& graph = walk.graph;
  const bool has_tree = corner.is_busy() && corner.busy().first_box != FDCG_NONE;
  if (!has_tree) {
    const Beginning plain = beside_all_faces(walk, corner);
    if (plain != Beginning::not_told) return plain;
  }
  const Vec3<Real> t = walk.hip - corner.point();
  FanEntry edge = {};  // any, but none that points straight away from the HIP
  Real most = 0;
  uint32_t seen = 0;
  const auto choose = [&](const FanEntry& entry, Real by) {
    if (seen++ == 0 || by > most) edge = entry, most = by;
  };
  if (has_tree) {  // ... and in whose faces' planes the HIP is not: hundreds beside them would lie in the plane of the way
    for (uint32_t i = 0; i < kEdgesAround; ++i) {
      const FanEntry entry = graph.fan_entry(corner, corner.fan_count() / kEdgesAround * i);
      choose(entry, entry.node == FDCG_NONE ? Real(-1) : absolute(dot(t, graph.node(entry.node).normal())));
    }
  } else {
    graph.for_each_in_fan(corner, [&](const FanEntry& entry) {
      const Real along = dot(t, graph.direction(entry.connection));
      choose(entry, !has_two_faces(graph, entry) ? -RealLimits<Real>::kFar : entry.end == 0 ? along : -along);
    });
  }
  // A file that is SAFE, and not FULL, may have a border at a corner that does not say so.
  if (edge.node == FDCG_NONE || graph.connection(edge.connection).type() == FDCG_BOUNDARY) return Beginning::not_told;
  WayToEdge<Geometry> way(walk, corner, edge);
  bool is_told = true;
  if (has_tree) {
    is_told = pass_by_tree(walk, corner, way);
  } else {
    graph.for_each_in_fan(corner, [&](const FanEntry& entry) { way.pass(entry); });
  }
  walk.spend(way.work());
  if (!is_told) return Beginning::not_told;
  return way.is_outside() ? Beginning::outside : Beginning::inside;
}

}  // namespace fdcg
