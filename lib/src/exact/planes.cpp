// SPDX-License-Identifier: Apache-2.0
#include "exact/planes.hpp"

#include <algorithm>

#include "base/vec3.hpp"
#include "shared/face_plane.hpp"  // stored bits are those that the runtime computes of a face that moves

namespace fdcg::bake {
namespace {

fdcg::Vec3<double> of_runtime(const Vec3& v) {
  return {v.x, v.y, v.z};
}
Vec3 of_lib(const fdcg::Vec3<double>& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

Vec3 unit_of_any_size(const Vec3& v) {
  return of_lib(fdcg::unit_of_any_size(of_runtime(v)));
}

Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return of_lib(unit_normal_of(of_runtime(a), of_runtime(b), of_runtime(c)));
}

double balanced_offset(const Vec3& normal, std::span<const Vec3> points) {
  const Vec3& first = points.front();
  double lowest = 0, highest = 0;
  for (const Vec3& point : points.subspan(1)) {
    const double height = dot(normal, point - first);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  return offset_through<double>(of_runtime(normal), of_runtime(first), 0.5 * (lowest + highest));
}

Plane stored_plane(const Vec3& normal, std::span<const Vec3> points, Precision precision) {
  if (precision == Precision::f64) return {normal, balanced_offset(normal, points)};
  const Vec3 rounded{static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)};
  return {rounded, static_cast<float>(balanced_offset(rounded, points))};
}

double angle_between(const Vec3& a, const Vec3& b) {
  return angle_of(of_runtime(a), of_runtime(b));
}

}  // namespace fdcg::bake
