// SPDX-License-Identifier: Apache-2.0
#include "exact/plane_fit.hpp"

#include "base/vec3.hpp"
#include "exact/planes.hpp"

namespace fdcg::bake {

void PlaneFit::add(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (const Vec3* point : {&a, &b, &c}) {
    const Vec3 d = *point - about_;
    sum_ = sum_ + d;
    squares_ = squares_ + Vec3{d.x * d.x, d.y * d.y, d.z * d.z};
    products_ = products_ + Vec3{d.y * d.z, d.z * d.x, d.x * d.y};
  }
  count_ += 3;
  area_ = area_ + cross(b - a, c - a);
}

Vec3 PlaneFit::mean_normal() const {
  return unit(area_);
}

Vec3 PlaneFit::centre() const {
  return about_ + (1 / count_) * sum_;
}

PlaneFit::Fitted PlaneFit::fit(const Vec3& normal) const {
  // Axes u, v in the plane; s = a u + b v is the least-squares height over it, and normal - a u - b v is the tilted normal.
  const Vec3 helper = dominant_axis(normal) == 0 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  const Vec3 u = unit(cross(helper, normal)), v = cross(normal, u);
  const Vec3 mean = (1 / count_) * sum_;
  const auto moment = [&](const Vec3& p, const Vec3& q) {  // of the projections on p and q, about the mean
    const double raw = squares_.x * p.x * q.x + squares_.y * p.y * q.y + squares_.z * p.z * q.z +
                       products_.x * (p.y * q.z + p.z * q.y) + products_.y * (p.z * q.x + p.x * q.z) +
                       products_.z * (p.x * q.y + p.y * q.x);
    return raw - count_ * dot(mean, p) * dot(mean, q);
  };
  const double uu = moment(u, u), uv = moment(u, v), vv = moment(v, v), un = moment(u, normal), vn = moment(v, normal);
  const double determinant = uu * vv - uv * uv;
  constexpr double kLeastWidth = 1e-12;  // (width / length)^2; below it rounding error determines the second axis
  if (!(determinant > kLeastWidth * (uu + vv) * (uu + vv))) return {normal, centre()};
  const double a = (un * vv - vn * uv) / determinant, b = (vn * uu - un * uv) / determinant;
  return {unit(normal - a * u - b * v), centre()};
}

}  // namespace fdcg::bake
