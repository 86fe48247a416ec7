// SPDX-License-Identifier: Apache-2.0
// Plain arithmetic of points and vectors in double, for evaluation code that needs no wider numbers.
#pragma once

#include <array>
#include <cmath>

namespace fdcg::test::plain {

using Point = std::array<double, 3>;

inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point operator*(const Point& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Point& a) {
  return std::sqrt(dot(a, a));
}
// Zero stays zero.
inline Point unit(const Point& a) {
  const double l = length(a);
  return l > 0 ? a * (1 / l) : a;
}

// The nearest point of a triangle and what it lies on: bit k of `on` is set for each corner that has weight in it. By the
// regions of Ericson, Real-Time Collision Detection (2005), 5.1.5.
struct OnTriangle {
  Point point;
  unsigned on;
};
inline OnTriangle nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, 1};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {b, 2};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + ab * (d1 / (d1 - d3)), 3};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {c, 4};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + ac * (d2 / (d2 - d6)), 5};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 6};
  const double scale = 1 / (va + vb + vc);
  return {a + ab * (vb * scale) + ac * (vc * scale), 7};
}

}  // namespace fdcg::test::plain
