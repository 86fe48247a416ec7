// SPDX-License-Identifier: Apache-2.0
#include "exact_sign.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cmath>

namespace fdcg::test {
namespace {

// Of the products' absolute sum: what rounding may move the determinant by (Shewchuk 1997, orient3d, bound A).
constexpr double kUnit = 0x1p-53, kBound = (7 + 56 * kUnit) * kUnit;
constexpr double kLeast = 1e-200;  // below, products may underflow

int by_interval_and_exactly(const Hip& a, const Hip& b, const Hip& c, const Hip& d) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  return CGAL::orientation(Point(a[0], a[1], a[2]), Point(b[0], b[1], b[2]), Point(c[0], c[1], c[2]), Point(d[0], d[1], d[2]));
}

}  // namespace

int exact_sign(const Hip& a, const Hip& b, const Hip& c, const Hip& d) {
  const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
  const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
  const double wx = d[0] - a[0], wy = d[1] - a[1], wz = d[2] - a[2];
  const double x0 = uy * vz, x1 = uz * vy, y0 = uz * vx, y1 = ux * vz, z0 = ux * vy, z1 = uy * vx;
  const double sum = (x0 - x1) * wx + (y0 - y1) * wy + (z0 - z1) * wz;
  const double size = (std::abs(x0) + std::abs(x1)) * std::abs(wx) + (std::abs(y0) + std::abs(y1)) * std::abs(wy) +
                      (std::abs(z0) + std::abs(z1)) * std::abs(wz);
  if (size > kLeast && std::abs(sum) > kBound * size) return sum > 0 ? 1 : -1;
  return by_interval_and_exactly(a, b, c, d);
}

}  // namespace fdcg::test
