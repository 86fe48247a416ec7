// SPDX-License-Identifier: Apache-2.0
// Arithmetic on Vec3, each operation rounded once.
#pragma once

#include <algorithm>
#include <cmath>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a) {
  return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(double s, const Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared_length(const Vec3& a) {
  return dot(a, a);
}
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline double largest_component(const Vec3& a) {
  return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
}
inline double component(const Vec3& a, int k) {
  return k == 0 ? a.x : k == 1 ? a.y : a.z;
}
// The axis of the largest component, the first of equal ones.
inline int dominant_axis(const Vec3& a) {
  const double x = std::fabs(a.x), y = std::fabs(a.y), z = std::fabs(a.z);
  if (x >= y && x >= z) return 0;
  return y >= z ? 1 : 2;
}

}  // namespace fdcg::bake
