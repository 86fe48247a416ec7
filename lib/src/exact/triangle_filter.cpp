// SPDX-License-Identifier: Apache-2.0
// Two kinds of tests. Signs of 3 x 3 determinants, whose error is bounded by the size of their terms; and separating axes,
// which need not be accurate themselves: only the rounding error of the projections onto them is bounded.
#include "exact/triangle_filter.hpp"

#include <cmath>
#include <cstddef>

#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr double kUnit = 0x1p-53;
// Each for vectors whose components are at most 1: rounded differences of coordinates.
// A determinant: 6 terms of at most 8 roundings; doubled, which covers the bound's own rounding.
constexpr double kDeterminantError = 96 * kUnit;
// A projection m . x, in units of the sum of m's components: 4 roundings; doubled.
constexpr double kProjectionError = 8 * kUnit;
// The scalar product of two vector products: 12 terms of at most 12 roundings; nearly doubled.
constexpr double kNormalsError = 256 * kUnit;
// Bounds below this are not trusted: underflow, at most 2^-900 with coordinates up to kLargestFiltered, could matter.
constexpr double kLeastError = 0x1p-850;
// Tilt of a separating plane about the shared corner, so that the side through which it passes lies clearly on one side of it.
constexpr double kTilt = 0x1p-10;

double sum_norm(const Vec3& a) {
  return std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z);
}

double larger(double a, double b) {
  return a > b ? a : b;
}
double largest(const Vec3& a, const Vec3& b) {
  return larger(larger(larger(std::fabs(a.x), std::fabs(b.x)), larger(std::fabs(a.y), std::fabs(b.y))),
                larger(std::fabs(a.z), std::fabs(b.z)));
}

// Whether m . p and m . q are certainly negative, m . a and m . b certainly positive. `size`: the largest component of the
// four.
bool separates_corner(const Vec3& m, double size, const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  const double error = kProjectionError * sum_norm(m) * size;
  return error > kLeastError && dot(m, p) < -error && dot(m, q) < -error && dot(m, a) > error && dot(m, b) > error;
}

// The triangles share one corner, the origin; p, q are the other corners of one, a, b those of the other.
bool are_apart_at_corner(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  const double size = larger(largest(p, q), largest(a, b));
  if (separates_corner((a + b) - (p + q), size, p, q, a, b)) return true;
  const double error = kDeterminantError * size * size * size;
  if (!(error > kLeastError)) return false;
  const auto are_on_one_side = [error](const Vec3& normal, const Vec3& u, const Vec3& v) {
    const double first = dot(normal, u), second = dot(normal, v);
    return (first > error && second > error) || (first < -error && second < -error);
  };
  const Vec3 n = cross(p, q);
  if (are_on_one_side(n, a, b)) return true;
  const Vec3 k = cross(a, b);
  if (are_on_one_side(k, p, q)) return true;
  // Planes perpendicular to a triangle's plane, through one of its sides at the shared corner.
  const double tilt_n = kTilt * sum_norm(n), tilt_k = kTilt * sum_norm(k);
  return separates_corner(cross(n, q) - tilt_n * q, size, p, q, a, b) ||
         separates_corner(cross(p, n) - tilt_n * p, size, p, q, a, b) ||
         separates_corner(cross(k, b) - tilt_k * b, size, a, b, p, q) ||
         separates_corner(cross(a, k) - tilt_k * a, size, a, b, p, q);
}

// The triangles share one side, from the origin to e; r and s are the opposite corners. These are coplanar with e and on the
// same side of it only if the vector products point the same way and the volume of e, r and s is zero.
bool are_apart_at_side(const Vec3& e, const Vec3& r, const Vec3& s) {
  const double size = larger(largest(e, r), largest(e, s)), volume = size * size * size;
  if (!(kNormalsError * size * volume > kLeastError)) return false;
  const Vec3 n = cross(e, r);
  if (dot(n, cross(e, s)) < -kNormalsError * size * volume) return true;
  return std::fabs(dot(n, s)) > kDeterminantError * volume;
}

using Points = std::array<Vec3, 3>;

// Whether all of b lies beyond all of a along m. `size`: the largest component of the points.
bool separates(const Vec3& m, double size, const Points& a, const Points& b) {
  const double error = 2 * kProjectionError * sum_norm(m) * size;
  const double most = larger(larger(dot(m, a[0]), dot(m, a[1])), dot(m, a[2]));
  const double least = -larger(larger(-dot(m, b[0]), -dot(m, b[1])), -dot(m, b[2]));
  return error > kLeastError && least - most > error;
}

bool share_nothing_and_are_apart(const ContactTriangle& s, const ContactTriangle& t) {
  const Vec3& o = *s.corner[0];
  const Points a{{{}, *s.corner[1] - o, *s.corner[2] - o}};
  const Points b{*t.corner[0] - o, *t.corner[1] - o, *t.corner[2] - o};
  const double size = larger(larger(largest(a[1], a[2]), largest(b[0], b[1])), largest(b[2], b[2]));
  if (separates((b[0] + b[1] + b[2]) - (a[1] + a[2]), size, a, b)) return true;
  const Vec3 n = cross(a[1], a[2]), k = cross(b[1] - b[0], b[2] - b[0]);
  // Axes: the triangles' normals (which need not be exact) and the outward normals of the sides within the planes.
  return separates(n, size, a, b) || separates(-n, size, a, b) || separates(k, size, a, b) || separates(-k, size, a, b) ||
         separates(cross(a[1], n), size, a, b) || separates(cross(a[2] - a[1], n), size, a, b) ||
         separates(cross(n, a[2]), size, a, b) || separates(cross(b[1] - b[0], k), size, b, a) ||
         separates(cross(b[2] - b[1], k), size, b, a) || separates(cross(b[0] - b[2], k), size, b, a);
}

}  // namespace

bool are_surely_apart(const ContactTriangle& s, const ContactTriangle& t) {
  std::size_t count = 0, in_s = 0, in_t = 0;  // shared corners; the sums of their indices give the index that is not shared
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const bool is_shared = s.corner[i] == t.corner[j];
      count += is_shared;
      in_s += is_shared ? i : 0;
      in_t += is_shared ? j : 0;
    }
  }
  if (count == 0) return share_nothing_and_are_apart(s, t);
  if (count == 1) {
    const Vec3& o = *s.corner[in_s];
    return are_apart_at_corner(*s.corner[(in_s + 1) % 3] - o, *s.corner[(in_s + 2) % 3] - o, *t.corner[(in_t + 1) % 3] - o,
                               *t.corner[(in_t + 2) % 3] - o);
  }
  if (count == 2) {
    const std::size_t r = 3 - in_s;
    const Vec3& o = *s.corner[(r + 1) % 3];
    // A seam counts as interior, so common points along it matter: left to contact_of.
    const bool has_seam = ((s.seams >> (r + 1) % 3 | t.seams >> (3 - in_t + 1) % 3) & 1u) != 0;
    return !has_seam && are_apart_at_side(*s.corner[(r + 2) % 3] - o, *s.corner[r] - o, *t.corner[3 - in_t] - o);
  }
  return false;
}

}  // namespace fdcg::bake
