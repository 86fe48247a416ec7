// SPDX-License-Identifier: Apache-2.0
// An object's pose prepared for use, and the transforms between its frame and the world.
#pragma once

#include "fdcg/scene.h"
#include "shared/vec.hpp"

namespace fdcg {

// How far the length of a unit vector or quaternion that a caller gives may be from 1.
inline constexpr double kUnitTolerance = 1e-3;

using World = Vec3<double>;

// A graph's bounds in its object's frame, in metres; enlarged by more than rounding (also that of a float graph) can move a
// point near it.
struct Bounds {
  World centre, half;
  double radius;            // of the sphere around centre
  bool is_endless = false;  // the half-space z < 0: the other fields are not used

  explicit Bounds(const fdcg_header& header) {
    constexpr double kGrowth = 0x1p-16;
    const double unit = header.metres_per_unit;
    double mid[3], reach[3];
    for (int k = 0; k < 3; ++k) {
      mid[k] = ((header.bounds_min[k] + header.bounds_max[k]) / 2 + header.origin[k]) * unit;
      reach[k] = (header.bounds_max[k] - header.bounds_min[k]) / 2 * unit;
    }
    centre = vec(mid);
    half = vec(reach);
    const double grow = (norm(half) + header.extent * unit) * kGrowth + 2 * header.max_deviation * unit;
    half = half + World{grow, grow, grow};
    radius = norm(half) * (1 + kGrowth);
  }
  // Of what lies within `half_size` around the origin.
  static Bounds around_origin(World half_size) {
    constexpr double kGrowth = 0x1p-16;
    const double grow = norm(half_size) * kGrowth;
    Bounds bounds = {};
    bounds.half = half_size + World{grow, grow, grow};
    bounds.radius = norm(bounds.half) * (1 + kGrowth);
    return bounds;
  }
  static Bounds endless() {
    Bounds bounds = {};
    bounds.radius = kEndless_m;
    bounds.is_endless = true;
    return bounds;
  }
  // Used as the radius of an endless object: farther than any HIP, with a finite square.
  static constexpr double kEndless_m = 1e110;
  Bounds() = default;
};

struct Pose {
  World row[3];  // of the rotation: world = row . object
  World translation;
  double scale;
  World centre;   // of the bounding sphere
  double radius;  // of the bounding sphere
  bool is_plain;  // neither turned nor scaled

  Pose() = default;
  // Cost: some 50 multiplications. `asked` is in range, its quaternion unit.
  [[gnu::noinline]] Pose(const fdcg_pose& asked, const Bounds& bounds)
      : translation(vec(asked.translation_m)), scale(asked.scale) {
    const double x = asked.rotation_xyzw[0], y = asked.rotation_xyzw[1], z = asked.rotation_xyzw[2], w = asked.rotation_xyzw[3];
    row[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)};
    row[1] = {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)};
    row[2] = {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)};
    is_plain = x == 0 && y == 0 && z == 0 && scale == 1;
    centre = to_world(bounds.centre, true);
    radius = bounds.radius * scale;
  }

  // Adding zero makes -0 to 0, so that with and without the skip every bit is the same.
  [[nodiscard]] World to_object(World x, bool may_skip) const {
    const World t = x - translation;
    if (may_skip && is_plain) return t + World{0, 0, 0};
    const World turned = row[0] * t.x + row[1] * t.y + row[2] * t.z + World{0, 0, 0};
    return {turned.x / scale, turned.y / scale, turned.z / scale};
  }
  // Of a direction with its length: a force, a gap.
  [[nodiscard]] World turned_to_world(World v, bool may_skip) const {
    if (may_skip && is_plain) return v + World{0, 0, 0};
    const World turned = {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
    return turned * scale + World{0, 0, 0};
  }
  [[nodiscard]] World to_world(World v, bool may_skip) const { return turned_to_world(v, may_skip) + translation; }
};

// An upper bound of how far any point within three radii of the bounding sphere's centre moves against the sphere's centre, and
// of how far the centre moves, between two poses of one scale. (A change of
// rotation moves a unit vector by no more than its Frobenius norm over the square root of 2.)
inline double largest_move(const Pose& from, const Pose& to) {
  constexpr double kRadii = 3, kRoundUp = 1 + 0x1p-20;
  double turned2 = 0;
  for (int k = 0; k < 3; ++k) {
    const World change = to.row[k] - from.row[k];
    turned2 += dot(change, change);
  }
  return (norm(to.centre - from.centre) + kRadii * to.radius * root(0.5 * turned2)) * kRoundUp;
}

}  // namespace fdcg
