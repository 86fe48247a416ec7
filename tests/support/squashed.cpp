// SPDX-License-Identifier: Apache-2.0
#include "squashed.hpp"

#include <cmath>

#include "random.hpp"

namespace fdcg::test {

PolygonSoup double_fan(int n, std::uint64_t seed) {
  constexpr double kTurn = 6.283185307179586;
  const auto m = static_cast<std::uint32_t>(n);
  std::vector<Vec3> points;
  // By less than half a turn from one to the next, and all between the apexes: no fan crosses itself or the other.
  for (std::uint32_t i = 0; i < m; ++i) {
    const double angle = kTurn * (i + 0.4 * hashed_unit(seed, 3 * i)) / n;
    const double radius = 0.1 + 0.9 * hashed_unit(seed, 3 * i + 1);
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), 1.6 * hashed_unit(seed, 3 * i + 2) - 0.8});
  }
  points.push_back({0, 0, 1});
  points.push_back({0, 0, -1});
  std::vector<Polygon> faces;
  for (std::uint32_t i = 0; i < m; ++i) {
    const std::uint32_t j = (i + 1) % m;
    faces.push_back({m, i, j});
    faces.push_back({m + 1, j, i});
  }
  return make_soup("double-fan", std::move(points), faces);
}

PolygonSoup stretched(const PolygonSoup& soup, int axis, double factor) {
  PolygonSoup result = soup;
  for (Vec3& p : result.points)
    (axis == 0 ? p.x : axis == 1 ? p.y : p.z) *= factor;
  return result;
}

}  // namespace fdcg::test
