// SPDX-License-Identifier: Apache-2.0
// Projection of a planar region along one coordinate axis. Dropping a coordinate is an exact affine map, so convexity, order on
// a line and orientation can be decided in the projection without error.
#pragma once

#include <cmath>

#include "base/vec3.hpp"
#include "exact/exact.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

class Projection {
 public:
  // Projects along the axis of the largest component of `normal`, seen from the side to which it points.
  explicit Projection(const Vec3& normal) : axis_(dominant_axis(normal)), sign_(component(normal, axis_) < 0 ? -1 : 1) {}

  // Orientation of a, b, c: +1 counter-clockwise, -1 clockwise, 0 collinear. Exact.
  [[nodiscard]] int orient(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const double left = (u(b) - u(a)) * (v(c) - v(a)), right = (v(b) - v(a)) * (u(c) - u(a));
    const double value = left - right, magnitude = std::fabs(left) + std::fabs(right);
    constexpr double kError = 4e-16;  // above Shewchuk's (3 + 16 u) u, u = 2^-53
    constexpr double kUnderflow = 1e-280;
    if (std::fabs(value) > kError * magnitude && magnitude > kUnderflow && std::isfinite(magnitude)) return value > 0 ? 1 : -1;
    return exact::orient2d(a, b, c, axis_) * sign_;
  }

  // For c on the line through a and b: whether b lies between a and c, so that the path a, b, c does not turn back. Exact.
  [[nodiscard]] bool goes_on(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return u(a) != u(b) ? (u(a) < u(b)) == (u(b) < u(c)) && u(b) != u(c) : (v(a) < v(b)) == (v(b) < v(c)) && v(b) != v(c);
  }

  // Whether x is in the closed triangle a, b, c, which is counter-clockwise.
  [[nodiscard]] bool contains(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) const {
    return orient(a, b, x) >= 0 && orient(b, c, x) >= 0 && orient(c, a, x) >= 0;
  }

  // The two kept coordinates; v is mirrored where the view is from the negative side, so that orientations are preserved.
  [[nodiscard]] double u(const Vec3& p) const { return axis_ == 0 ? p.y : axis_ == 1 ? p.z : p.x; }
  [[nodiscard]] double v(const Vec3& p) const { return sign_ * (axis_ == 0 ? p.z : axis_ == 1 ? p.x : p.y); }

 private:
  int axis_, sign_;
};

}  // namespace fdcg::bake
