// SPDX-License-Identifier: Apache-2.0
// The exact sign of an orientation, without heap or library.
#pragma once

#include "vec.hpp"

namespace fdcg {

// The sign (-1, 0, +1) of ((b - a) x (c - a)) . (d - a): +1 when d is in front of the plane a, b, c (counter-clockwise seen
// from its front). Exact for coordinates whose triple products neither overflow nor fall below the smallest normal number
// (magnitudes of 1e-80 to 1e80 are safe). Some 10 ns where rounding cannot matter, at most some 20 microseconds elsewhere.
// Source: error-free transformations and expansions as in Shewchuk, Adaptive Precision Floating-Point Arithmetic (1997).
int orient3d_sign(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, const Vec3<double>& d);

template <class Real>
inline Vec3<double> widen(Vec3<Real> a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

}  // namespace fdcg
