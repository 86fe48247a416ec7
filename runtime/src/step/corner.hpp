// SPDX-License-Identifier: Apache-2.0
// The god-object on a vertex (contact-model CORNER-1 to CORNER-7; in place of Melder 2004, sections 5g and 7).
#pragma once

#include "graph/implicit_tree.hpp"
#include "step/edge.hpp"
#include "step/walk.hpp"

namespace fdcg {

// The steepest descent from a corner: the face, edge or (where neither climbs) apex along which t = HIP - v reaches furthest,
// which is the one nearest to the HIP: |t|^2 = reach^2 + distance^2.
template <class Real>
struct Steepest {
  Feature feature = kFree;  // kFree stands for the apex
  Real reach2 = 0;
  Real distance2 = 0;  // of the HIP from it

  // contact-model CORNER-2: of the two squares the smaller tells best: near a groove all reaches are one number, far from it
  // all distances are.
  void take_steeper(const Steepest& other, Real half_t2) {
    const bool are_near = distance2 < half_t2 && other.distance2 < half_t2;
    if (FDCG_MUTANT("steepest-at-vertex") ? feature == kFree : are_near ? other.distance2 < distance2 : other.reach2 > reach2)
      *this = other;
  }
};

// One entry of the fan: its edge, and the face to the left of it.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] void consider_fan_entry(const GraphView<Geometry>& graph, const FanEntry& entry, Vec3<Real> t, Real half_t2,
                                          Steepest<Real>& best) {
  const Vec3<Real> direction = graph.edge(entry.connection).direction;
  const Real forward = dot(t, direction);
  if (entry.end == 0 ? forward > 0 : forward < 0) {
    const Vec3<Real> off = t - direction * forward;
    best.take_steeper({{FDCG_EDGE, entry.connection}, square(forward), dot(off, off)}, half_t2);
  }
  if (entry.node == FDCG_NONE) return;
  const NodeRef<Geometry> node = graph.node(entry.node);
  if (!(dot(node.voronoi_plane(entry.outgoing).normal, t) < 0)) return;
  if (!(dot(node.voronoi_plane(node.previous(entry.outgoing)).normal, t) < 0)) return;
  const Vec3<Real> normal = node.normal();
  const Real height = dot(normal, t);
  const Vec3<Real> in_plane = t - normal * height;
  best.take_steeper({{FDCG_FACE, entry.node}, dot(in_plane, in_plane), square(height)}, half_t2);
}

// Looks at every edge of the corner.
template <class Geometry, class Real = typename Geometry::Real>
inline Steepest<Real> steepest_of_all(Walk<Geometry>& walk, CornerRef<Geometry> corner, Vec3<Real> t) {
  const GraphView<Geometry>& graph = walk.graph;
  walk.spend(kFanWork * corner.fan_count());
  const Real t2 = dot(t, t);
  Steepest<Real> best = {kFree, 0, t2};
  graph.for_each_in_fan(corner, [&](const FanEntry& entry) { consider_fan_entry(graph, entry, t, t2 / 2, best); });
  return best;
}

// What one search of a busy corner's tree may spend; what it has found by then is taken. Cones, crowns and needles of 10,000
// sides take 100 to 300.
inline constexpr uint32_t kFanSearchWork = 600;

// The most that t.u can be for a unit vector u of the box, or more: the lesser of what the box alone allows, and, since u is no
// longer than 1, of sup over the box of t.u - (|t|/2) (|u|^2 - 1), which is tight where u can point along t but for a little.
template <class Real, class FanBox>
inline Real most_along(const FanBox& box, Vec3<Real> t, Real length) {
  const Vec3<Real> centre = vec(box.centre);
  const Real along_centre = dot(t, centre), weight = length / 2;
  Real in_box = along_centre, in_ball = along_centre + weight * (1 - dot(centre, centre));
  for (const auto& stored : box.axis) {  // u = centre + s axis, |s| <= 1
    const Vec3<Real> axis = vec(stored);
    const Real along = dot(t, axis), off = dot(centre, axis), size2 = dot(axis, axis);
    in_box += absolute(along);
    const Real top = along - length * off, limit = length * size2;  // of the parabola in s: at top / limit
    const Real s = top >= limit ? Real(1) : top <= -limit ? Real(-1) : top / limit;
    in_ball += s * (top - weight * size2 * s);
  }
  return in_ball < in_box ? in_ball : in_box;
}

// contact-model CORNER-7: branch and bound over a busy corner's tree: a box whose best direction reaches no further than what
// is found, but for rounding, is left out. So one of several directions that tie is taken: at the apex of a regular fan they
// all do.
template <class Geometry, class Real = typename Geometry::Real>
inline Steepest<Real> steepest_by_tree(Walk<Geometry>& walk, CornerRef<Geometry> corner, Vec3<Real> t) {
  const GraphView<Geometry>& graph = walk.graph;
  struct Waiting {
    Real bound;
    uint32_t box;  // within its level
    int level;
  };
  const ImplicitTree layout(corner.fan_count(), FDCG_LEAF_FAN);
  const auto* boxes = graph.fan_boxes + corner.busy().first_box;
  const Real tie = 64 * RealLimits<Real>::kEpsilon * norm1(t);  // the rounding of boxes and directions is under half of it
  const Real length = norm(t);
  const auto bound_of = [&](int level, uint32_t i) { return most_along(boxes[layout.first[level] + i], t, length) - tie; };
  const Real t2 = dot(t, t);
  Steepest<Real> best = {kFree, 0, t2};
  Real reach = 0;
  uint32_t best_entry = 0;
  const auto consider = [&](uint32_t i) {
    const Feature before = best.feature;
    consider_fan_entry(graph, graph.fan_entry(corner, i), t, t2 / 2, best);
    if (best.feature == before) return false;
    best_entry = i;
    return true;
  };
  Waiting stack[kMaxLevels + 2];
  int waiting = 0;
  stack[waiting++] = {bound_of(layout.levels - 1, 0), 0, layout.levels - 1};
  uint32_t work = 0;
  while (waiting > 0 && work < kFanSearchWork) {
    const Waiting next = stack[--waiting];
    if (!(next.bound > reach)) continue;
    if (next.level == 0) {
      const uint32_t first = next.box * FDCG_LEAF_FAN;
      const uint32_t count = corner.fan_count() - first < FDCG_LEAF_FAN ? corner.fan_count() - first : FDCG_LEAF_FAN;
      for (uint32_t i = first; i < first + count; ++i)
        consider(i);
      reach = root(best.reach2);
      work += kFanWork * count;
      continue;
    }
    work += 2 * kFanBoxWork;
    const int level = next.level - 1;
    const uint32_t child = next.box * 2;
    const bool has_two = child + 1 < layout.size[level];
    const Waiting first = {bound_of(level, child), child, level};
    const Waiting second = {has_two ? bound_of(level, child + 1) : Real(0), child + 1, level};
    const bool second_is_better = has_two && second.bound > first.bound;
    if (has_two) stack[waiting++] = second_is_better ? first : second;
    stack[waiting++] = second_is_better ? second : first;
  }
  // Boxes cannot tell apart what reaches as far up to rounding error; the neighbours of the one found may yet be nearer.
  const uint32_t entries = corner.fan_count();
  for (bool goes_on = best.feature.state != FDCG_FREE; goes_on && work < kFanSearchWork; work += 2 * kFanWork) {
    const uint32_t here = best_entry;
    const bool is_before = consider(here > 0 ? here - 1 : entries - 1);
    goes_on = consider(here + 1 < entries ? here + 1 : 0) || is_before;
  }
  walk.spend(work);
  return best;
}

// contact-model CORNER-4: HIP is in front of the face that is nearest: free, up to rounding error. Where it stands on a concave
// edge of that face at the corner and behind the face across, edge and faces are as near as one another, and any of them may
// have been found: then it is the edge's to say, unless it stands before the edge's end: the edge would hand the god-object
// back to the corner. So are the two walls of a narrow slit that it stands between: one of them may hold it.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] Feature edge_that_holds(Walk<Geometry>& walk, NodeRef<Geometry> node, uint32_t corner, Vec3<Real> t) {
  for (uint32_t k = 0; k < node.side_count(); ++k) {
    const bool starts_here = node.corner(k) == corner;
    if (!starts_here && node.corner(node.next(k)) != corner) continue;
    const ConnectionRef<Geometry> connection = walk.graph.connection(node.connection(k));
    if (connection.type() != FDCG_CONCAVE) continue;
    walk.spend(kEdgeWork);
    const Real along = dot(walk.graph.edge(node, k).direction, t);
    if ((starts_here == (node.which(k) == 0) ? along : -along) < -walk.hip_bound) continue;
    const bool is_between_walls = node.voronoi_plane(k).distance(walk.hip) < -walk.hip_bound;
    for (uint32_t end = 0; end < 2; ++end) {
      const Feature face = {FDCG_FACE, connection.node(end)};
      const NodeRef<Geometry> wall = walk.graph.node(face.index);
      if (walk.side(wall) >= 0) continue;
      if (!is_between_walls) return {FDCG_EDGE, node.connection(k)};
      if (wall.voronoi_plane(connection.side(end)).distance(walk.hip) < 0) return face;
    }
  }
  return kFree;
}

// What the steepest descent comes to: where to go on, or the corner itself (contact-model CORNER-3, CORNER-5).
template <class Geometry, class Real = typename Geometry::Real>
inline Feature next_from_corner(Walk<Geometry>& walk, CornerRef<Geometry> corner, Vec3<Real> t) {
  const bool has_tree = corner.is_busy() && corner.busy().first_box != FDCG_NONE;
  const Steepest<Real> best = has_tree ? steepest_by_tree(walk, corner, t) : steepest_of_all(walk, corner, t);
  if (best.feature.state == FDCG_FACE) {
    const NodeRef<Geometry> node = walk.graph.node(best.feature.index);
    return walk.side(node) < 0 ? best.feature : edge_that_holds(walk, node, walk.active.index, t);
  }
  if (best.feature.state == FDCG_EDGE) {
    const ConnectionRef<Geometry> connection = walk.graph.connection(best.feature.index);
    EdgeSides<Real> s;
    look_at_sides(walk, connection, &s);
    if (connection.type() == FDCG_BOUNDARY) {
      return s.side[0] < 0 && s.voronoi[0] < 0 ? Feature{FDCG_FACE, connection.node(0)} : kFree;
    }
    return is_free_of_edge(connection.type(), s.side[0] < 0, s.side[1] < 0) ? kFree : best.feature;
  }
  if (corner.is_open() && !FDCG_MUTANT("open-corner")) return kFree;
  return dot(t, corner.normal()) < 0 ? walk.active : kFree;
}

// contact-model CORNER-6: a god-object beside the corner `point`, where an edge's rule left it (walk.hpp,
// snapping_increases_distance), as far from the corner on `next` instead, straight down: so it is no farther from the HIP than
// it was, which at the corner it might be. Free, the way begins at the corner, lest it pass below a face of it. `t`: from the
// corner to the HIP.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline]] Vec3<Real> moved_beside(const Walk<Geometry>& walk, Feature next, Vec3<Real> point, Vec3<Real> t) {
  if (next == kFree) return point;
  Vec3<Real> down;  // to the foot of the HIP on `next`
  if (next.state == FDCG_FACE) {
    const Vec3<Real> normal = walk.graph.node(next.index).normal();
    down = t - normal * dot(normal, t);
  } else {
    const Vec3<Real> direction = walk.graph.edge(next.index).direction;
    down = direction * dot(direction, t);
  }
  const Real off = norm(walk.god_object - point), length = norm(down);
  return point + (off < length ? down * (off / length) : down);
}

// Cost: one connection, one node and two Voronoi planes for each edge of the corner; at a busy corner for some eight of them,
// and the logarithm of their number in boxes.
template <class Geometry, class Real = typename Geometry::Real>
inline Decision corner_rule(Walk<Geometry>& walk) {
  const CornerRef<Geometry> corner = walk.graph.corner(walk.active.index);
  const Vec3<Real> point = corner.point(), t = walk.hip - point;
  const Feature next = next_from_corner(walk, corner, t);
  if (next == walk.active) return rest();
  if (norm1(walk.god_object - point) > 0) walk.god_object = moved_beside(walk, next, point, t);
  return go_to(next);
}

}  // namespace fdcg
