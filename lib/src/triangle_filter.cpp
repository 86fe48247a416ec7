// SPDX-License-Identifier: Apache-2.0
// Two kinds of evidence. Signs of 3 x 3 determinants, whose error is bounded by the size of their terms; and vectors that
// happen to separate: these need no accuracy of their own, only the projections on them are bounded.
#include "triangle_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "vec.hpp"

namespace fdcg::bake {
namespace {

constexpr double kUnit = 0x1p-53;
// A determinant of rounded differences: at most 8 roundings in each of its terms, whose magnitudes add up to at most
// 2 |u| |v| |w|_1 (| |: largest component); doubled, which covers the bound's own rounding.
constexpr double kDeterminantError = 32 * kUnit;
// A projection m . x of a rounded difference: 4 roundings, magnitudes up to |m|_1 |x|; doubled.
constexpr double kProjectionError = 8 * kUnit;
// The scalar product of two vector products that share a factor: 12 roundings, 12 |e|^2 |r| |s|; nearly doubled.
constexpr double kNormalsError = 256 * kUnit;
// Bounds below this are not trusted: underflow, at most 2^-900 with coordinates up to kLargestFiltered, could matter.
constexpr double kLeastError = 0x1p-850;
// How far a plane through a side is turned about the shared corner, so that the side itself lies clearly beyond it.
constexpr double kTilt = 0x1p-10;

double sum_norm(const Vec3& a) {
  return std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z);
}

// The points lie on one side of the plane through the origin along u and v, whose vector product is `normal`.
template <std::size_t kCount>
bool are_on_one_side(const Vec3& normal, double size_uv, const std::array<Vec3, kCount>& points) {
  double least = INFINITY, most = -INFINITY, farthest = 0;
  for (const Vec3& p : points) {
    const double side = dot(normal, p);
    least = std::min(least, side);
    most = std::max(most, side);
    farthest = std::max(farthest, sum_norm(p));
  }
  const double error = kDeterminantError * size_uv * farthest;
  return error > kLeastError && (least > error || most < -error);
}

// m . p and m . q are surely negative, m . a and m . b surely positive. `size`: the largest component of the four.
bool separates_corner(const Vec3& m, double size, const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  const double error = kProjectionError * sum_norm(m) * size;
  return error > kLeastError && std::max(dot(m, p), dot(m, q)) < -error && std::min(dot(m, a), dot(m, b)) > error;
}

// One corner is shared, the origin; p, q are the others of one triangle, a, b those of the other.
bool are_apart_at_corner(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  const Vec3 n = cross(p, q);
  const double size_p = largest_component(p), size_q = largest_component(q);
  if (are_on_one_side<2>(n, size_p * size_q, {a, b})) return true;
  const Vec3 k = cross(a, b);
  const double size_a = largest_component(a), size_b = largest_component(b);
  if (are_on_one_side<2>(k, size_a * size_b, {p, q})) return true;
  const double size = std::max({size_p, size_q, size_a, size_b});
  if (separates_corner(a + b - p - q, size, p, q, a, b)) return true;
  // Planes across the triangles' own, through a side that ends in the shared corner.
  const double tilt_n = kTilt * sum_norm(n), tilt_k = kTilt * sum_norm(k);
  return separates_corner(cross(n, q) - tilt_n * q, size, p, q, a, b) ||
         separates_corner(cross(p, n) - tilt_n * p, size, p, q, a, b) ||
         separates_corner(cross(k, b) - tilt_k * b, size, a, b, p, q) ||
         separates_corner(cross(a, k) - tilt_k * a, size, a, b, p, q);
}

// One side is shared, from the origin to e; r and s are the corners opposite to it. They lie in one plane on the same side of e
// only if the vector products look the same way, and only if r, s and e have no volume.
bool are_apart_at_side(const Vec3& e, const Vec3& r, const Vec3& s) {
  const double size_e = largest_component(e), size_r = largest_component(r), size_s = largest_component(s);
  const Vec3 n = cross(e, r);
  const double error = kNormalsError * size_e * size_e * size_r * size_s;
  if (error > kLeastError && dot(n, cross(e, s)) < -error) return true;
  return are_on_one_side<1>(n, size_e * size_r, {s});
}

// All of b lies beyond all of a along m. `size`: the largest component of the points, which are differences to a[0].
bool separates(const Vec3& m, double size, const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const double error = 2 * kProjectionError * sum_norm(m) * size;
  const double most = std::max({0.0, dot(m, a[1]), dot(m, a[2])});
  const double least = std::min({dot(m, b[0]), dot(m, b[1]), dot(m, b[2])});
  return error > kLeastError && least - most > error;
}

bool share_nothing_and_are_apart(const ContactTriangle& s, const ContactTriangle& t) {
  const auto from = [](const Vec3& o, const ContactTriangle& triangle) {
    return std::array<Vec3, 3>{*triangle.corner[0] - o, *triangle.corner[1] - o, *triangle.corner[2] - o};
  };
  const Vec3 &o = *s.corner[0], &oo = *t.corner[0];
  const std::array<Vec3, 3> a = from(o, s), b = from(o, t);
  const Vec3 n = cross(a[1], a[2]);
  if (are_on_one_side<3>(n, largest_component(a[1]) * largest_component(a[2]), b)) return true;
  const std::array<Vec3, 3> bb = from(oo, t), aa = from(oo, s);
  const Vec3 k = cross(bb[1], bb[2]);
  if (are_on_one_side<3>(k, largest_component(bb[1]) * largest_component(bb[2]), aa)) return true;
  // Planes across the triangles' own, along their sides, looking outwards.
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i)
    size = std::max({size, largest_component(a[i]), largest_component(b[i])});
  if (separates(cross(a[1], n), size, a, b) || separates(cross(a[2] - a[1], n), size, a, b) ||
      separates(cross(n, a[2]), size, a, b))
    return true;
  size = 0;
  for (std::size_t i = 0; i < 3; ++i)
    size = std::max({size, largest_component(aa[i]), largest_component(bb[i])});
  return separates(cross(bb[1], k), size, bb, aa) || separates(cross(bb[2] - bb[1], k), size, bb, aa) ||
         separates(cross(k, bb[2]), size, bb, aa);
}

}  // namespace

bool are_surely_apart(const ContactTriangle& s, const ContactTriangle& t) {
  std::size_t count = 0, in_s = 0, in_t = 0;  // shared corners; the sums of their places tell which is left of three
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
    // A seam is no common side: what lies along it counts, for which contact_of is asked.
    const bool has_seam = ((s.seams >> (r + 1) % 3 | t.seams >> (3 - in_t + 1) % 3) & 1u) != 0;
    return !has_seam && are_apart_at_side(*s.corner[(r + 2) % 3] - o, *s.corner[r] - o, *t.corner[3 - in_t] - o);
  }
  return false;
}

}  // namespace fdcg::bake
