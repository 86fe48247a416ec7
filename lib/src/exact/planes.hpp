// SPDX-License-Identifier: Apache-2.0
// Unit normals, offsets and edge directions, accurate to one or two units in the last place whatever the triangle's shape.
#pragma once

#include <cmath>
#include <span>

#include "base/vec3.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// distance(x) = normal . x + offset, positive outside.
struct Plane {
  Vec3 normal;
  double offset = 0;
};

// unit((b - a) x (c - a)), with error-free differences and products where rounding matters, so that needle triangles are as
// accurate as equilateral ones. Zero where the three points are exactly collinear.
[[nodiscard]] Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c);

// unit(v), without overflow or underflow over the whole exponent range; zero stays zero.
[[nodiscard]] Vec3 unit_of_any_size(const Vec3& v);
[[nodiscard]] inline Vec3 unit(const Vec3& v) {
  constexpr double kSmall = 1e-200, kLarge = 1e200;  // their squares and products stay in range
  const double squared = squared_length(v);
  if (!(squared > kSmall && squared < kLarge)) return unit_of_any_size(v);
  const double norm = std::sqrt(squared);
  return {v.x / norm, v.y / norm, v.z / norm};
}

// unit(b - a); edge_direction(b, a) is its exact negative.
[[nodiscard]] inline Vec3 edge_direction(const Vec3& a, const Vec3& b) {
  return unit(b - a);
}

// The offset that minimises the largest distance of the points from the plane, for the rounded normal.
[[nodiscard]] double balanced_offset(const Vec3& normal, std::span<const Vec3> points);

// The plane of these corners as the file will store it: the normal rounded to the precision, then the offset balanced for
// that normal and rounded.
[[nodiscard]] Plane stored_plane(const Vec3& normal, std::span<const Vec3> points, Precision precision);

// Whether the edge from a to b is within 45 degrees of the plane. An edge that is not has no useful Voronoi plane; noise makes
// such edges where they are as short as the quantum.
[[nodiscard]] inline bool runs_along(const Vec3& normal, const Vec3& a, const Vec3& b) {
  const Vec3 step = b - a;
  const double off = dot(normal, step);
  return 2 * off * off <= squared_length(step);
}

// The angle between two unit vectors, 0 .. pi, within 4e-8 of itself (Abramowitz and Stegun 4.4.46): a weight for a corner's
// normal, of which only the direction matters. Uses additions, products and square roots only, so that every compiler and C
// library gives the same bits.
[[nodiscard]] double angle_between(const Vec3& a, const Vec3& b);

}  // namespace fdcg::bake
