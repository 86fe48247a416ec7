// SPDX-License-Identifier: Apache-2.0
// Attitude and inertia of a rigid body.
#pragma once

#include "fdcg/body.h"
#include "shared/vec.hpp"

namespace fdcg {

using Vector = Vec3<double>;

inline void put(Vector v, double (&to)[3]) {
  to[0] = v.x, to[1] = v.y, to[2] = v.z;
}
inline double component(Vector v, int k) {
  return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

// Rows.
struct Matrix {
  Vector row[3];

  [[nodiscard]] Vector operator*(Vector v) const { return {dot(row[0], v), dot(row[1], v), dot(row[2], v)}; }
  [[nodiscard]] Vector transposed_times(Vector v) const { return row[0] * v.x + row[1] * v.y + row[2] * v.z; }
};

// x, y, z, w of unit length; world = rotation * object.
inline Matrix rotation_of(const double (&q)[4]) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

inline Matrix tensor_of(const double (&i)[6]) {
  return {{{i[0], i[3], i[4]}, {i[3], i[1], i[5]}, {i[4], i[5], i[2]}}};
}

// m x = b, by cofactors; m is far from singular.
inline Vector solve(const Matrix& m, Vector b) {
  const Vector bc = cross(m.row[1], m.row[2]), ca = cross(m.row[2], m.row[0]), ab = cross(m.row[0], m.row[1]);
  const double inverse = 1 / dot(m.row[0], bc);
  return (bc * b.x + ca * b.y + ab * b.z) * inverse;
}

// Of a symmetrical one.
inline Matrix inverse_of(const Matrix& m) {
  const Vector bc = cross(m.row[1], m.row[2]), ca = cross(m.row[2], m.row[0]), ab = cross(m.row[0], m.row[1]);
  const double inverse = 1 / dot(m.row[0], bc);
  return {{bc * inverse, ca * inverse, ab * inverse}};
}

}  // namespace fdcg
