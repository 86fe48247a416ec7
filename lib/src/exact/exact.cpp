// SPDX-License-Identifier: Apache-2.0
#include "exact/exact.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace fdcg::bake::exact {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point3 = Kernel::Point_3;
using Point2 = Kernel::Point_2;

Point3 point(const Vec3& v) {
  return {v.x, v.y, v.z};
}

// The projection along axis k that keeps the cyclic order of the other two.
Point2 project(const Vec3& v, int k) {
  if (k == 0) return {v.y, v.z};
  if (k == 1) return {v.z, v.x};
  return {v.x, v.y};
}

}  // namespace

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return static_cast<int>(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int k) {
  return static_cast<int>(CGAL::orientation(project(a, k), project(b, k), project(c, k)));
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return CGAL::collinear(point(a), point(b), point(c));
}

int dot_sign(const Vec3& a, const Vec3& b, const Vec3& c) {
  return static_cast<int>(CGAL::angle(point(b), point(a), point(c)));
}

}  // namespace fdcg::bake::exact
