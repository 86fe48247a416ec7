// SPDX-License-Identifier: Apache-2.0
#include "drilled_plate.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace fdcg::test {

PolygonSoup drilled_plate(int around) {
  constexpr double kHole = 0.5, kHalfHeight = 0.15;
  std::vector<Vec3> points;
  for (const double z : {-kHalfHeight, kHalfHeight}) {
    for (int i = 0; i < 4; ++i) {
      const double angle = (2 * i + 1) * std::numbers::pi / 4;
      points.push_back({std::sqrt(2.0) * std::cos(angle), std::sqrt(2.0) * std::sin(angle), z});
    }
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * k * std::numbers::pi / around;
      points.push_back({kHole * std::cos(angle), kHole * std::sin(angle), z});
    }
  }
  const auto n = static_cast<std::uint32_t>(around), top = n + 4;
  const auto hole = [&](std::uint32_t k) { return 4 + k % n; };
  std::vector<Polygon> faces;
  const auto both_sides = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    faces.push_back({a + top, b + top, c + top});
    faces.push_back({c, b, a});
  };
  const auto wall = [&](std::uint32_t a, std::uint32_t b) { faces.push_back({a, b, b + top, a + top}); };
  for (std::uint32_t i = 0; i < 4; ++i) {
    both_sides(i, (i + 1) % 4, hole((i + 1) * n / 4));
    wall(i, (i + 1) % 4);
    for (std::uint32_t k = i * n / 4; k < (i + 1) * n / 4; ++k) {
      both_sides(i, hole(k + 1), hole(k));
      wall(hole(k + 1), hole(k));
    }
  }
  return triangulated(make_soup("drilled plate", std::move(points), faces));
}

}  // namespace fdcg::test
