// SPDX-License-Identifier: Apache-2.0
// Surfaces in long double, written from their definitions: how far a point is from the material, and the normal there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "fdcg/surface.h"
#include "scene_rig.hpp"

namespace fdcg::test {

using Long = long double;
using LongPlace = std::array<Long, 3>;

inline LongPlace wide(const Place& p) {
  return {p[0], p[1], p[2]};
}
inline LongPlace wide(const double (&p)[3]) {
  return {p[0], p[1], p[2]};
}
inline LongPlace minus(const LongPlace& a, const LongPlace& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Long dot(const LongPlace& a, const LongPlace& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Long length(const LongPlace& a) {
  return std::sqrt(dot(a, a));
}

// Of a point of a plane from a segment.
inline Long segment_distance(Long x, Long y, Long ax, Long ay, Long bx, Long by) {
  const Long dx = bx - ax, dy = by - ay, l2 = dx * dx + dy * dy;
  const Long t = l2 > 0 ? std::clamp(((x - ax) * dx + (y - ay) * dy) / l2, Long(0), Long(1)) : 0;
  return std::hypot(x - ax - t * dx, y - ay - t * dy);
}

// Of a cylinder, cone or frustum: of its half cross-section.
inline Long cone_distance(const fdcg_surface& s, const LongPlace& p) {
  const Long r0 = s.radius_m, r1 = s.kind == FDCG_SURFACE_CYLINDER ? s.radius_m : s.top_radius_m, h = Long(s.length_m) / 2;
  const Long off = std::hypot(p[0], p[1]), z = p[2];
  const Long nearest = std::min({segment_distance(off, z, r0, -h, r1, h), segment_distance(off, z, 0, -h, r0, -h),
                                 segment_distance(off, z, 0, h, r1, h)});
  const bool is_in = std::abs(z) < h && (off - r0) * 2 * h - (r1 - r0) * (z + h) < 0;
  return is_in ? -nearest : nearest;
}

inline Long box_distance(const fdcg_surface& s, const LongPlace& p) {
  LongPlace out = {};
  Long most = -1e300L;
  for (int k = 0; k < 3; ++k) {
    const Long over = std::abs(p[k]) - s.half_m[k];
    most = std::max(most, over);
    out[k] = std::max(over, Long(0));
  }
  return most < 0 ? most : length(out);
}

// To first order in the distance.
inline Long ellipsoid_distance(const fdcg_surface& s, const LongPlace& p) {
  Long value = -1, slope2 = 0;
  for (int k = 0; k < 3; ++k) {
    const Long a = s.half_m[k];
    value += p[k] / a * (p[k] / a);
    slope2 += p[k] / (a * a) * (p[k] / (a * a));
  }
  return slope2 > 0 ? value / (2 * std::sqrt(slope2)) : -std::min({s.half_m[0], s.half_m[1], s.half_m[2]});
}

// Positive outside the solid; of a hollow surface positive inside.
inline Long outside_distance(const fdcg_surface& s, const LongPlace& p) {
  const Long sign = s.is_hollow != 0 ? -1 : 1, half = Long(s.length_m) / 2;
  switch (s.kind) {
    case FDCG_SURFACE_PLANE:
      return p[2];
    case FDCG_SURFACE_SPHERE:
      return sign * (length(p) - s.radius_m);
    case FDCG_SURFACE_CAPSULE:
      return sign * (length({p[0], p[1], p[2] - std::clamp(p[2], -half, half)}) - s.radius_m);
    case FDCG_SURFACE_BOX:
      return sign * box_distance(s, p);
    case FDCG_SURFACE_TORUS:
      return sign * (std::hypot(std::hypot(p[0], p[1]) - s.radius_m, p[2]) - s.tube_radius_m);
    case FDCG_SURFACE_ELLIPSOID:
      return sign * ellipsoid_distance(s, p);
    default:
      return sign * cone_distance(s, p);
  }
}

// The largest coordinate that the surface has, and what a hand may be asked to stay near of a plane.
inline double extent_of(const fdcg_surface& s) {
  const double wide = std::max(s.radius_m, s.top_radius_m);
  const double most = std::max({wide + s.tube_radius_m, s.half_m[0], s.half_m[1], s.half_m[2],
                                s.length_m / 2 + (s.kind == FDCG_SURFACE_CAPSULE ? wide : 0)});
  return most > 0 ? most : 1;
}

// Of a face, at a point of it: the gradient of the defining equation.
inline LongPlace face_normal(const fdcg_surface& s, std::uint32_t feature, const LongPlace& p) {
  const Long half = Long(s.length_m) / 2, off = std::hypot(p[0], p[1]);
  LongPlace n = {0, 0, 1};
  switch (s.kind) {
    case FDCG_SURFACE_PLANE:
      return n;
    case FDCG_SURFACE_SPHERE:
      n = p;
      break;
    case FDCG_SURFACE_CAPSULE:
      n = {p[0], p[1], p[2] - std::clamp(p[2], -half, half)};
      break;
    case FDCG_SURFACE_BOX:
      n = {0, 0, 0};
      n[feature / 2] = feature % 2 != 0 ? 1 : -1;
      break;
    case FDCG_SURFACE_TORUS:
      n = {p[0] * (1 - s.radius_m / off), p[1] * (1 - s.radius_m / off), p[2]};
      break;
    case FDCG_SURFACE_ELLIPSOID:
      for (int k = 0; k < 3; ++k)
        n[k] = p[k] / (Long(s.half_m[k]) * s.half_m[k]);
      break;
    default:
      if (feature != 0) {
        n = {0, 0, feature == 1 ? Long(-1) : Long(1)};
      } else {
        const Long grows = (s.kind == FDCG_SURFACE_CYLINDER ? 0 : Long(s.top_radius_m) - s.radius_m);
        n = {p[0] / off * s.length_m, p[1] / off * s.length_m, -grows};
      }
  }
  const Long scale = (s.is_hollow != 0 ? -1 : 1) / length(n);
  return {n[0] * scale, n[1] * scale, n[2] * scale};
}

}  // namespace fdcg::test
