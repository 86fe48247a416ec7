// SPDX-License-Identifier: Apache-2.0
// The exact orientation test, without heap or libraries.
#pragma once

#include "shared/vec.hpp"

namespace fdcg {

// The sign (-1, 0, +1) of ((b - a) x (c - a)) . (d - a): +1 when d is in front of the plane a, b, c (counter-clockwise seen
// from its front). Exact for every finite coordinate up to 1e70. Some 70 instructions where the filter decides, else some 900;
// for points in a plane, or within 2^-98 of the size of one, 2,000, or 9,000 where the coordinates differ very much in size.
// Work beyond the 70 is subtracted from *work_left; null: not counted.
int orient3d_sign(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, const Vec3<double>& d,
                  uint32_t* work_left = nullptr);

template <class Real>
inline Vec3<double> widen(Vec3<Real> a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

// The same of floats.
FDCG_ONE_COPY int orient3d_sign(const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c, const Vec3<float>& d,
                                uint32_t* work_left) {
  return orient3d_sign(widen(a), widen(b), widen(c), widen(d), work_left);
}

}  // namespace fdcg
