// SPDX-License-Identifier: Apache-2.0
// The least box around some corners' points, by the processor's vectors where it has them.
#pragma once

#include <string.h>

#include "fdcg/format.h"
#include "graph/unit_check.hpp"

namespace fdcg {

template <class Real>
class PointBounds {
 public:
#if FDCG_HAS_VECTORS
  explicit PointBounds(const Real* point) {
    for (int part = 0; part < kParts; ++part)
      low_[part] = high_[part] = load(point + part);
  }
  [[gnu::always_inline]] void add(const Real* point) {
#pragma GCC unroll 2
    for (int part = 0; part < kParts; ++part) {
      const Reals reals = load(point + part);
      low_[part] = low_[part] < reals ? low_[part] : reals;
      high_[part] = high_[part] > reals ? high_[part] : reals;
    }
  }
  [[nodiscard]] Real low(int axis) const {
    return low_[part_of(axis)][axis - part_of(axis)];
  }
  [[nodiscard]] Real high(int axis) const {
    return high_[part_of(axis)][axis - part_of(axis)];
  }

 private:
  // Of doubles x and y, y and z; of floats x, y, z and the number that follows them in the corner's record.
  using Reals = typename Vectors<Real>::Reals;
  static constexpr int kParts = sizeof(Real) == 8 ? 2 : 1;
  static_assert(offsetof(fdcg_corner_f32, point) + sizeof(Reals) <= sizeof(fdcg_corner_f32));

  static int part_of(int axis) {
    return axis == 2 ? kParts - 1 : 0;
  }
  static Reals load(const Real* from) {
    Reals reals;
    memcpy(&reals, from, sizeof reals);
    return reals;
  }

  Reals low_[kParts], high_[kParts];
#else
  explicit PointBounds(const Real* point) : low_{point[0], point[1], point[2]}, high_{point[0], point[1], point[2]} {}
  void add(const Real* point) {
    for (int axis = 0; axis < 3; ++axis) {
      if (point[axis] < low_[axis]) low_[axis] = point[axis];
      if (point[axis] > high_[axis]) high_[axis] = point[axis];
    }
  }
  [[nodiscard]] Real low(int axis) const {
    return low_[axis];
  }
  [[nodiscard]] Real high(int axis) const {
    return high_[axis];
  }

 private:
  Real low_[3], high_[3];
#endif
};

}  // namespace fdcg
