// SPDX-License-Identifier: Apache-2.0
// Scalar products, and rotations by unit quaternions, real part last.
#pragma once

#include <cmath>

namespace fdcg::dev {

inline bool is_finite(const double v[3]) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

inline double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The rotation matrix, row-major.
inline void rows_of(const double q[4], double rows[9]) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double matrix[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                            2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                            2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  for (int i = 0; i < 9; ++i)
    rows[i] = matrix[i];
}

// v + 2 w (u x v) + 2 u x (u x v). *turned may be v itself.
inline void turn(const double q[4], const double v[3], double turned[3]) {
  const double c[3] = {q[1] * v[2] - q[2] * v[1], q[2] * v[0] - q[0] * v[2], q[0] * v[1] - q[1] * v[0]};
  turned[0] = v[0] + 2 * (q[3] * c[0] + q[1] * c[2] - q[2] * c[1]);
  turned[1] = v[1] + 2 * (q[3] * c[1] + q[2] * c[0] - q[0] * c[2]);
  turned[2] = v[2] + 2 * (q[3] * c[2] + q[0] * c[1] - q[1] * c[0]);
}

// a after b.
inline void multiply(const double a[4], const double b[4], double product[4]) {
  product[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
  product[1] = a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0];
  product[2] = a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3];
  product[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
}

}  // namespace fdcg::dev
