// SPDX-License-Identifier: Apache-2.0
// The box. Its faces are planes across the axes, so that the rules (contact-model FACE-1, EDGE-1, CORNER-1 and on) take each
// axis for itself: a wall is active where the god-object is on it and the HIP behind it.
#pragma once

#include "surface/surface.hpp"

namespace fdcg {

struct BoxSurface {
  static constexpr bool kIsConvex = true;
  double sign, extent;
  double half[3];

  explicit BoxSurface(const fdcg_surface& s)
      : sign(s.is_hollow != 0 ? -1 : 1), extent(norm1(vec(s.half_m))), half{s.half_m[0], s.half_m[1], s.half_m[2]} {}

  [[nodiscard]] bool is_outside(Point p) const {
    const double x = absolute(p.x) - half[0], y = absolute(p.y) - half[1], z = absolute(p.z) - half[2];
    return sign > 0 ? x >= 0 || y >= 0 || z >= 0 : x <= 0 && y <= 0 && z <= 0;
  }
  [[nodiscard]] bool is_clear(Point p, double way) const {
    const double x = absolute(p.x) - half[0], y = absolute(p.y) - half[1], z = absolute(p.z) - half[2];
    return sign > 0 ? x > way || y > way || z > way : x < -way && y < -way && z < -way;
  }
  [[nodiscard]] Span span(Point from, Point way) const {
    Span span = kWholeLine;
    cut_slab(from.x, way.x, half[0], 0, &span);
    cut_slab(from.y, way.y, half[1], 2, &span);
    cut_slab(from.z, way.z, half[2], 4, &span);
    return span;
  }
  // The face whose plane is nearest, of those that x is behind in a cavity.
  [[nodiscard]] uint32_t piece_near(Point p) const {
    const double x[3] = {p.x, p.y, p.z};
    uint32_t axis = 0;
    for (uint32_t k = 1; k < 3; ++k) {
      if (absolute(x[k]) - half[k] > absolute(x[axis]) - half[axis]) axis = k;
    }
    return 2 * axis + (x[axis] > 0 ? 1 : 0);
  }
  [[nodiscard]] Entry land(uint32_t piece, Point at) const {
    double x[3] = {at.x, at.y, at.z};
    for (uint32_t k = 0; k < 3; ++k)
      x[k] = x[k] > half[k] ? half[k] : (x[k] < -half[k] ? -half[k] : x[k]);
    x[piece / 2] = piece % 2 != 0 ? half[piece / 2] : -half[piece / 2];
    return {true, {x[0], x[1], x[2]}, {FDCG_FACE, piece}};
  }
  [[nodiscard]] Entry enter(Point from, Point to, bool begins_outside) const {
    return enter_convex(*this, from, to, begins_outside);
  }

  // What of the box presses on the god-object: for each axis the side of the wall, or 0, and the HIP's depth behind it.
  struct Walls {
    int side[3];
    double load[3];
    int count;
  };

  // A cavity's walls on which the god-object is and behind which the HIP is; a solid's one active face, if the HIP is behind
  // it.
  [[nodiscard]] Walls walls(const double (&at)[3], const double (&hip)[3], Feature active) const {
    Walls walls = {{0, 0, 0}, {0, 0, 0}, 0};
    for (uint32_t k = 0; k < 3; ++k) {
      const bool is_on = sign > 0 ? active.index / 2 == k : absolute(at[k]) >= half[k];
      const double load = at[k] > 0 ? sign * (half[k] - hip[k]) : sign * (half[k] + hip[k]);
      if (!is_on || !(load > 0)) continue;
      walls.side[k] = at[k] > 0 ? 1 : -1;
      walls.load[k] = load;
      ++walls.count;
    }
    return walls;
  }
  static Feature feature_of(const Walls& walls) {
    uint32_t plus = 0, on = 0, off = 0;
    for (uint32_t k = 0; k < 3; ++k) {
      if (walls.side[k] > 0) plus |= 1u << k;
      if (walls.side[k] != 0) on = k;
      if (walls.side[k] == 0) off = k;
    }
    if (walls.count == 3) return {FDCG_VERTEX, plus};
    if (walls.count == 1) return {FDCG_FACE, 2 * on + (plus != 0 ? 1u : 0u)};
    const uint32_t low = off == 0 ? 1 : 0, high = off == 2 ? 1 : 2;
    return {FDCG_EDGE, 4 * off + (plus >> low & 1u) + 2 * (plus >> high & 1u)};
  }
  // The load of the walls together: their sum on a concave edge, or the paper's distance.
  static double load_of(const Walls& walls, bool has_wedge) {
    if (has_wedge || walls.count == 1) return walls.load[0] + walls.load[1] + walls.load[2];
    return root(squared(vec(walls.load)));
  }

  // Within a face, off its edges.
  FDCG_HOT bool slide_quickly(uint32_t face, Touch& touch) const {
    if (face > 5) return false;  // a contact of another surface
    const uint32_t k = face / 2, i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
    double at[3] = {touch.god_object.x, touch.god_object.y, touch.god_object.z};
    const double hip[3] = {touch.hip.x, touch.hip.y, touch.hip.z};
    const double load = at[k] > 0 ? sign * (half[k] - hip[k]) : sign * (half[k] + hip[k]);
    const double gap_i = at[i] - hip[i], gap_j = at[j] - hip[j];
    if (!(absolute(at[i]) < half[i] && absolute(at[j]) < half[j])) return false;
    double shrink = 0;
    const Slid slid = slide_on_plane(touch, {gap_i, gap_j, 0}, load, &shrink);
    if (slid != Slid::kSlides) return slid == Slid::kRests;
    at[i] = hip[i] + gap_i * shrink;
    at[j] = hip[j] + gap_j * shrink;
    if (!(absolute(at[i]) < half[i] && absolute(at[j]) < half[j])) return false;
    touch.god_object = {at[0], at[1], at[2]};
    return true;
  }
  // Along the axes that no wall takes, to where friction stops it or the first end. Each round ends on one wall more.
  Decision rule(SurfaceWalk& walk) const {
    double at[3] = {walk.god_object.x, walk.god_object.y, walk.god_object.z};
    const double hip[3] = {walk.hip.x, walk.hip.y, walk.hip.z};
    const Walls on = walls(at, hip, walk.active);
    if (on.count == 0) return go_to(kFree);
    const Feature here = feature_of(on);
    if (!(here == walk.active)) return go_to(here);
    if (on.count == 3) return rest();
    double gap[3];
    for (int k = 0; k < 3; ++k)
      gap[k] = on.side[k] != 0 ? 0 : at[k] - hip[k];
    double shrink = 0;
    const Slid slid = slide_on_plane(walk, vec(gap), load_of(on, walk.friction.has_wedge), &shrink);
    if (slid != Slid::kSlides) return decide(slid, kFree);
    int end = -1;
    double first = 1;
    for (int k = 0; k < 3; ++k) {
      const double to = hip[k] + gap[k] * shrink;
      if (on.side[k] != 0 || !(absolute(to) > half[k])) continue;
      const double left = to > 0 ? half[k] - at[k] : half[k] + at[k], part = left / absolute(to - at[k]);
      if (end < 0 || part < first) end = k, first = part;
    }
    for (int k = 0; k < 3; ++k) {
      if (on.side[k] != 0) continue;
      const double to = hip[k] + gap[k] * shrink;
      at[k] = end < 0 ? to : at[k] + (to - at[k]) * first;
      at[k] = at[k] > half[k] ? half[k] : (at[k] < -half[k] ? -half[k] : at[k]);
      if (k == end) at[k] = to > 0 ? half[k] : -half[k];
    }
    walk.god_object = {at[0], at[1], at[2]};
    if (end < 0) return rest();
    // A solid's edge, beyond which the HIP is. A cavity's: there may be friction along it, or another wall.
    return sign > 0 ? go_to(kFree) : go_to(feature_of(walls(at, hip, walk.active)));
  }
  [[nodiscard]] Point normal(Feature feature, Point x, Point) const {
    const double at[3] = {x.x, x.y, x.z};
    double n[3];
    for (uint32_t k = 0; k < 3; ++k) {
      const bool is_on = feature.state == FDCG_FACE   ? feature.index / 2 == k
                         : feature.state == FDCG_EDGE ? feature.index / 4 != k
                                                      : true;
      n[k] = !is_on ? 0 : (at[k] > 0 ? sign : -sign);
    }
    const Point sum = vec(n);
    return sum * (1 / norm(sum));
  }
};

}  // namespace fdcg
