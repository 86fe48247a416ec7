// SPDX-License-Identifier: Apache-2.0
// Three numbers, for looking at files.
#pragma once

#include <array>
#include <cmath>

namespace fdcg::tools {

using Triple = std::array<double, 3>;

inline Triple triple(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}
inline double dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Triple minus(const Triple& a, const Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Triple& a) {
  return std::sqrt(dot(a, a));
}

}  // namespace fdcg::tools
