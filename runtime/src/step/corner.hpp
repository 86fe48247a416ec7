// SPDX-License-Identifier: Apache-2.0
// The god-object on a vertex (contact-model CORNER-1 to CORNER-7; in place of Melder 2004, sections 5g and 7).
#pragma once

#include "graph/implicit_tree.hpp"
#include "step/corner_cone.hpp"
#include "step/edge.hpp"
#include "step/shaded_corner.hpp"
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
  [[nodiscard]] bool is_less_steep_than(const Steepest& other, Real half_t2) const {
    if (FDCG_MUTANT("steepest-at-vertex")) return feature.is_free();
    const bool are_near = distance2 < half_t2 && other.distance2 < half_t2;
    return are_near ? other.distance2 < distance2 : other.reach2 > reach2;
  }
};

// Whether the HIP is behind a face, or behind an edge as that rules, so that it holds the god-object (contact-model EDGE-1).
template <class Geometry, class Real>
[[gnu::noinline, gnu::cold]] bool holds(Walk<Geometry>& walk, Feature feature) {
  if (feature.state == FDCG_FACE) return walk.side(walk.graph.node(feature.index)) < 0;
  const ConnectionRef<Geometry> connection = walk.graph.connection(feature.index);
  EdgeSides<Real> s;
  look_at_sides(walk, connection, &s);
  if (connection.type() == FDCG_BOUNDARY) return s.side[0] < 0 && s.voronoi[0] < 0;
  return !lets_go(walk.graph, walk.hip_bound, connection.type(), s);
}

// The search around a corner. Where the HIP is known to be inside only what holds the god-object counts.
template <class Geometry>
struct FanSearch {
  using Real = typename Geometry::Real;

  Walk<Geometry>& walk;
  Vec3<Real> t;
  Real half_t2;
  bool must_hold;
  Steepest<Real> best;
  Real lost2;  // squared distance of the HIP from the nearest that did not hold

  FanSearch(Walk<Geometry>& a_walk, const Vec3<Real>& a_t, bool a_must_hold)
      : walk(a_walk),
        t(by_parts(a_t)),
        half_t2(dot(t, t) / 2),
        must_hold(a_must_hold),
        best{kFree, 0, 2 * half_t2},
        lost2(2 * half_t2) {}

  void offer(const Steepest<Real>& found) {
    if (!best.is_less_steep_than(found, half_t2)) return;
    if (!must_hold || holds(walk, found.feature)) {
      best = found;
    } else if (found.distance2 < lost2) {
      lost2 = found.distance2;
    }
  }
  // One entry of the fan: its edge, and the face to the left of it.
  [[gnu::noinline, gnu::cold]] void look_at(const FanEntry& entry) {
    const Vec3<Real> direction = walk.graph.direction(entry.connection);
    const Real forward = FDCG_MUTANT("corner-sees-no-edge") ? Real(0) : dot(t, direction);
    if (entry.end == 0 ? forward > 0 : forward < 0) {
      const Vec3<Real> off = t - direction * forward;
      offer({{FDCG_EDGE, entry.connection}, square(forward), dot(off, off)});
    }
    if (entry.node == FDCG_NONE || FDCG_MUTANT("corner-sees-no-face")) return;
    const NodeRef<Geometry> node = walk.graph.node(entry.node);
    if (!(dot(node.voronoi_plane(entry.outgoing).normal, t) < 0)) return;
    if (!(dot(node.voronoi_plane(node.previous(entry.outgoing)).normal, t) < 0)) return;
    const Vec3<Real> normal = node.normal();
    const Real height = dot(normal, t);
    const Vec3<Real> in_plane = t - normal * height;
    offer({{FDCG_FACE, entry.node}, dot(in_plane, in_plane), square(height)});
  }
};

// Looks at every edge of the corner.
template <class Geometry>
inline void search_all(FanSearch<Geometry>& search, CornerRef<Geometry> corner) {
  search.walk.spend(kFanWork * corner.fan_count());
  search.walk.graph.for_each_in_fan(corner, [&](const FanEntry& entry) { search.look_at(entry); });
}

// The most that t.u can be for a unit vector u of the box, or more: the lesser of what the box alone allows, and, since u is no
// longer than 1, of sup over the box of t.u - (|t|/2) (|u|^2 - 1), which is tight where u can point along t but for a little.
template <class Real, class FanBox>
[[gnu::noinline, gnu::cold]] Real most_along(const FanBox& box, const Vec3<Real>& t, Real length) {
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
[[gnu::noinline, gnu::cold]] void search_by_tree(FanSearch<Geometry>& search, CornerRef<Geometry> corner) {
  const GraphView<Geometry>& graph = search.walk.graph;
  const Vec3<Real> t = search.t;
  struct Waiting {
    Real bound;
    uint32_t box;  // within its level
    int level;
  };
  const ImplicitTree layout(corner.fan_count(), FDCG_LEAF_FAN);
  const auto* boxes = graph.fan_boxes() + corner.busy().first_box;
  const Real tie = fan_rounding<Real>(t);
  const Real length = norm(t);
  const auto bound_of = [&](int level, uint32_t i) { return most_along(boxes[layout.first[level] + i], t, length) - tie; };
  Real reach = 0;
  uint32_t best_entry = 0;
  const auto consider = [&](uint32_t i) {
    const Feature before = search.best.feature;
    const Real lost2 = search.lost2;
    search.look_at(graph.fan_entry(corner, i));
    if (search.best.feature == before && !(search.lost2 < lost2)) return false;
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
      reach = root(search.best.reach2);
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
  // Boxes cannot tell apart what reaches as far up to rounding error; the neighbours of the one found may yet be nearer, past
  // some that are nearer and do not hold.
  const uint32_t entries = corner.fan_count();
  const bool is_apex = search.best.feature.is_free() && search.lost2 == 2 * search.half_t2;
  for (bool goes_on = !is_apex; goes_on && work < kFanSearchWork; work += 2 * kFanWork) {
    const uint32_t here = best_entry;
    const bool is_before = consider(here > 0 ? here - 1 : entries - 1);
    goes_on = consider(here + 1 < entries ? here + 1 : 0) || is_before;
  }
  search.walk.spend(work);
}

// Where to go on from a corner, or the corner itself (contact-model CORNER-3, CORNER-5).
template <class Geometry, class Real = typename Geometry::Real>
inline Feature next_from_corner(Walk<Geometry>& walk, CornerRef<Geometry> corner, const Vec3<Real>& t) {
  const Beginning way = beginning_of_way(walk, corner);
  if (way == Beginning::outside && !FDCG_MUTANT("free-at-vertex")) return kFree;
  const bool is_inside = way != Beginning::not_told;
  if constexpr (kShades<Geometry>) {
    if (is_inside && walk.friction.terms != nullptr && is_at_shaded_face(walk, corner))
      return next_from_shaded_corner(walk, corner, t);
  }
  FanSearch<Geometry> search(walk, t, way == Beginning::inside);
  if (corner.is_busy() && corner.busy().first_box != FDCG_NONE) {
    search_by_tree(search, corner);
  } else {
    search_all(search, corner);
  }
  const Feature found = search.best.feature;
  const Real front = dot(t, corner.normal()), rounding = stored_normal_rounding(t);
  if (walk.graph.has_inexact_nodes()) {  // what CORNER-4 says is not exact
    const Real noise = slab_depth(2 * walk.graph.max_deviation(), walk.hip_bound);
    const bool is_apex = found.is_free() && search.lost2 == search.best.distance2;  // nothing else leads nearer
    if (is_apex && front > noise + rounding) return kFree;
    const Real share = found.is_free() ? kNearerThanApex2<Real> : kClearlyNearer2<Real>;
    if (search.lost2 < share * search.best.distance2 && search.best.distance2 > square(noise)) return kFree;
  }
  if (is_inside) return found.is_free() ? walk.active : found;
  if (found.is_free()) {
    const bool may_hold = !corner.is_open() || FDCG_MUTANT("open-corner");
    return may_hold && front < -rounding ? walk.active : kFree;
  }
  if (!holds(walk, found)) return kFree;
  const bool is_rim = found.state == FDCG_EDGE && walk.graph.connection(found.index).type() == FDCG_BOUNDARY;
  return is_rim ? Feature{FDCG_FACE, walk.graph.connection(found.index).node(0)} : found;
}

// Cost: one connection, one node and two Voronoi planes for each edge of the corner; at a busy corner for some eight of them,
// and the logarithm of their number in boxes.
template <class Geometry, class Real = typename Geometry::Real>
[[gnu::noinline, gnu::cold]] Decision corner_rule(Walk<Geometry>& walk) {
  const CornerRef<Geometry> corner = walk.graph.corner(walk.active.index);
  const Vec3<Real> t = walk.hip - corner.point();
  const Feature next = FDCG_MUTANT("corner-never-left")    ? walk.active
                       : FDCG_MUTANT("corner-always-free") ? kFree
                                                           : next_from_corner(walk, corner, t);
  if (next == walk.active) return rest();
  return go_to(next);
}

}  // namespace fdcg
