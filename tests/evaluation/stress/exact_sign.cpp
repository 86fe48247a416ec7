// SPDX-License-Identifier: Apache-2.0
#include "exact_sign.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace fdcg::test {

int exact_sign(const Hip& a, const Hip& b, const Hip& c, const Hip& d) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  return CGAL::orientation(Point(a[0], a[1], a[2]), Point(b[0], b[1], b[2]), Point(c[0], c[1], c[2]), Point(d[0], d[1], d[2]));
}

}  // namespace fdcg::test
