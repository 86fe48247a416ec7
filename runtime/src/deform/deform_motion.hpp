// SPDX-License-Identifier: Apache-2.0
// What a deformable mesh's motion in one tick does to a contact: a god-object moves with its feature, and a free one that a
// face passes over gets into contact.
//
// A triangle's way: its corners move one after another, in the order of their numbers, each along a straight line; so do those
// of its neighbours, and each such move sweeps one tetrahedron of every triangle at the corner. Tetrahedra of neighbours share
// a face, bit for bit. A point is passed over where it lay in front of a triangle or on it, lies behind it after the move, and
// is in the tetrahedron: four exact signs. A place on the border of two counts for both.
#pragma once

#include "deform/deform_upkeep.hpp"
#include "graph/tolerances.hpp"

namespace fdcg {

// A triangle's corners before and after.
struct MovedTriangle {
  Vec3<double> old_point[3], point[3];
  uint32_t corner[3];
};

// A place in a triangle: point[0] + a (point[1] - point[0]) + b (point[2] - point[0]).
struct PlaceInTriangle {
  double a, b;
};

// part / whole, 0 to 1; of nothing: 0.
inline double share(double part, double whole) {
  if (whole < 0) part = -part, whole = -whole;
  return !(part > 0) ? 0 : part < whole ? part / whole : 1;
}

inline double clamped(double x) {
  return !(x > 0) ? 0 : x < 1 ? x : 1;
}

inline PlaceInTriangle within(PlaceInTriangle place) {
  const double a = clamped(place.a), b = clamped(place.b), sum = a + b;
  return sum > 1 ? PlaceInTriangle{a / sum, b / sum} : PlaceInTriangle{a, b};
}

inline Vec3<double> point_at(PlaceInTriangle place, const Vec3<double> (&p)[3]) {
  return p[0] + (p[1] - p[0]) * place.a + (p[2] - p[0]) * place.b;
}

// Where the foot of a point stands; within the triangle. Of one without area: on its longest side.
inline PlaceInTriangle foot_in(const Vec3<double> (&p)[3], Vec3<double> x) {
  const Vec3<double> u = p[1] - p[0], v = p[2] - p[0], off = x - p[0], normal = cross(u, v);
  const double area2 = dot(normal, normal);
  if (area2 > 0) return within({dot(cross(off, v), normal) / area2, dot(cross(u, off), normal) / area2});
  const double uu = dot(u, u), vv = dot(v, v);
  return uu >= vv ? PlaceInTriangle{share(dot(off, u), uu), 0} : PlaceInTriangle{0, share(dot(off, v), vv)};
}

// The share of the way from end 0 to end 1 where the foot of x stands, 0 to 1.
inline double share_along(const Vec3<double> (&end)[2], Vec3<double> x) {
  const Vec3<double> along = end[1] - end[0];
  return share(dot(x - end[0], along), dot(along, along));
}

// At 0 and 1 the ends themselves, without rounding.
inline Vec3<double> point_along(const Vec3<double> (&end)[2], double share) {
  return share < 1 ? end[0] + (end[1] - end[0]) * share : end[1];
}

// Whether triangle v b c, counter-clockwise seen from its front, passes over x while v moves to w.
inline bool passes_over(Vec3<double> v, Vec3<double> w, Vec3<double> b, Vec3<double> c, Vec3<double> x) {
  return orient3d_sign(v, b, c, x) >= 0 && orient3d_sign(w, b, c, x) < 0 && orient3d_sign(v, w, b, x) >= 0 &&
         orient3d_sign(v, w, c, x) <= 0 && orient3d_sign(v, b, c, w) > 0;
}

// Whether the triangle passes over x, and where x is then; the last time counts.
inline bool passes_over(const MovedTriangle& t, Vec3<double> x, PlaceInTriangle* place) {
  Vec3<double> now[3] = {t.old_point[0], t.old_point[1], t.old_point[2]};
  bool is_met = false;
  uint32_t done = 0;
  for (int move = 0; move < 3; ++move) {
    uint32_t k = 3;
    for (uint32_t i = 0; i < 3; ++i) {
      if ((done >> i & 1) == 0 && (k == 3 || t.corner[i] < t.corner[k])) k = i;
    }
    done |= 1u << k;
    const uint32_t b = (k + 1) % 3, c = (k + 2) % 3;
    const Vec3<double> from = now[k], to = t.point[k];
    if (passes_over(from, to, now[b], now[c], x)) {
      is_met = true;
      const Vec3<double> way = to - from, to_b = now[b] - from, to_c = now[c] - from, off = x - from;
      const double volume = dot(cross(way, to_b), to_c);
      double weight[3];
      weight[b] = share(dot(cross(way, off), to_c), volume);
      weight[c] = share(dot(cross(way, to_b), off), volume);
      weight[k] = clamped(1 - weight[b] - weight[c]);
      *place = within({weight[1], weight[2]});
    }
    now[k] = to;
  }
  return is_met;
}

// How far into the tick the plane of a triangle reaches x, about: 0 to 1.
inline double when_met(const MovedTriangle& t, Vec3<double> x) {
  const auto distance = [&x](const Vec3<double>(&p)[3]) {
    const Vec3<double> normal = cross(p[1] - p[0], p[2] - p[0]);
    const double length = norm(normal);
    return length > 0 ? dot(normal, x - p[0]) / length : 0;
  };
  const double before = distance(t.old_point), after = distance(t.point);
  return share(before, before - after);
}

// The face that passes over a point first in the present tick, and where the point then is on it as it now lies.
struct Catch {
  uint32_t node = FDCG_NONE;
  double when = 2;
  Vec3<double> place = {0, 0, 0};
  bool is_in_box = false;  // some leaf's box holds the point, whether or not a face passed over it
};

template <class Real>
inline void try_to_catch(const Upkeep<Real>& upkeep, uint32_t n, Vec3<double> x, Catch* first) {
  MovedTriangle t;
  bool has_moved = false;
  for (uint32_t k = 0; k < 3; ++k) {
    t.corner[k] = upkeep.node(n).sides[k].corner;
    has_moved = has_moved || upkeep.has_moved(t.corner[k]);
  }
  if (!has_moved) return;
  for (uint32_t k = 0; k < 3; ++k) {
    t.old_point[k] = widen(upkeep.old_point(t.corner[k]));
    t.point[k] = widen(upkeep.point(t.corner[k]));
  }
  PlaceInTriangle place;
  if (!passes_over(t, x, &place)) return;
  const double when = when_met(t, x);
  if (when > first->when || (when == first->when && n > first->node)) return;
  first->node = n;
  first->when = when;
  first->place = point_at(place, t.point);
}

// Which of a record's boxes hold a point or are as near as that, a bit each.
inline uint32_t near_boxes(const fdcg_box8& record, const float (&point)[3], float near2) {
  float distance2[FDCG_TREE_WAYS];
  return squared_distances(record, point, near2, distance2);
}

// Cost: the boxes that hold the point, and the triangles in them.
template <class Real>
[[gnu::noinline]] Catch catch_of(const Upkeep<Real>& upkeep, Vec3<Real> at) {
  const fdcg_deform& deform = upkeep.deform();
  const BoxTree& tree = deform.tree;
  const Vec3<double> x = widen(at), p = upkeep.in_tree(at);
  const float point[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  const auto rounding = static_cast<float>(tree_rounding(2 * norm1(p), 0.0)), near2 = rounding * rounding;
  struct Item {
    uint32_t index;
    int level;
  } stack[(FDCG_TREE_WAYS - 1) * kMostTreeLevels + 1];
  int waiting = 0;
  stack[waiting++] = {0, tree.levels - 1};
  Catch first;
  while (waiting > 0) {
    const Item item = stack[--waiting];
    const fdcg_box8& record = deform.boxes[tree.first[item.level] + item.index];
    const uint32_t lanes = tree.lanes(item.level, item.index);
    uint32_t held = near_boxes(record, point, near2) & lanes;
    if (held != 0 && upkeep.has_tightened(item.level, item.index, held)) held &= near_boxes(record, point, near2);
    for (; held != 0; held &= held - 1) {
      const uint32_t below = item.index * FDCG_TREE_WAYS + static_cast<uint32_t>(__builtin_ctz(held));
      if (item.level > 0) {
        stack[waiting++] = {below, item.level - 1};
        continue;
      }
      first.is_in_box = true;
      const uint32_t begin = below * FDCG_LEAF_NODES, end = begin + FDCG_LEAF_NODES;
      for (uint32_t n = begin; n < end && n < deform.header.node_count; ++n)
        try_to_catch(upkeep, n, x, &first);
    }
  }
  return first;
}

}  // namespace fdcg
