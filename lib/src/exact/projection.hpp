// SPDX-License-Identifier: Apache-2.0
// A planar region seen along one axis: dropping a coordinate is an exact affine map, so convexity, order on a line and
// orientation can be decided there without error.
#pragma once

#include <cmath>

#include "base/vec3.hpp"
#include "exact/exact.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

class Projection {
 public:
  // Along the largest component of `normal`, from the side that it points to.
  explicit Projection(const Vec3& normal) : axis_(dominant_axis(normal)), sign_(component(normal, axis_) < 0 ? -1 : 1) {}

  // +1 where a, b, c turn left, -1 right, 0 on a line. Exact.
  [[nodiscard]] int orient(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const double left = (u(b) - u(a)) * (v(c) - v(a)), right = (v(b) - v(a)) * (u(c) - u(a));
    const double value = left - right, magnitude = std::fabs(left) + std::fabs(right);
    constexpr double kError = 4e-16;  // above Shewchuk's (3 + 16 u) u, u = 2^-53
    constexpr double kUnderflow = 1e-280;
    if (std::fabs(value) > kError * magnitude && magnitude > kUnderflow && std::isfinite(magnitude)) return value > 0 ? 1 : -1;
    return exact::orient2d(a, b, c, axis_) * sign_;
  }

  // c lies on the line through a and b: it is on the far side of b from a, so that b is passed straight. Exact.
  [[nodiscard]] bool goes_on(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return u(a) != u(b) ? (u(a) < u(b)) == (u(b) < u(c)) && u(b) != u(c) : (v(a) < v(b)) == (v(b) < v(c)) && v(b) != v(c);
  }

  // x is in the closed triangle a, b, c, which turns left.
  [[nodiscard]] bool contains(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) const {
    return orient(a, b, x) >= 0 && orient(b, c, x) >= 0 && orient(c, a, x) >= 0;
  }

  // The coordinates that are kept; v is mirrored where the view is from the negative side, so that left stays left.
  [[nodiscard]] double u(const Vec3& p) const { return axis_ == 0 ? p.y : axis_ == 1 ? p.z : p.x; }
  [[nodiscard]] double v(const Vec3& p) const { return sign_ * (axis_ == 0 ? p.z : axis_ == 1 ? p.x : p.y); }

 private:
  int axis_, sign_;
};

}  // namespace fdcg::bake
