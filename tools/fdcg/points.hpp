// SPDX-License-Identifier: Apache-2.0
// Arithmetic of three numbers.
#pragma once

#include <cmath>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

inline bake::Vec3 vec3(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}
inline bake::Vec3 plus(const bake::Vec3& a, double factor, const bake::Vec3& b) {
  return {a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
inline double dot(const bake::Vec3& a, const bake::Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline bake::Vec3 cross(const bake::Vec3& a, const bake::Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const bake::Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline double component(const bake::Vec3& a, int k) {
  return k == 0 ? a.x : k == 1 ? a.y : a.z;
}

}  // namespace fdcg::tools
