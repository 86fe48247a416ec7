// SPDX-License-Identifier: Apache-2.0
#include "repair/surface_cover.hpp"

#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"
#include "catch.hpp"
#include "random.hpp"

using namespace fdcg::bake;
using fdcg::test::Random;

namespace {

// The least distance over a fine grid of points of the triangle, by bisection-free brute force: an upper bound close to it.
double sampled_distance(const Vec3& p, const std::array<Vec3, 3>& t, int steps) {
  double least = 1e300;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const double u = static_cast<double>(i) / steps, v = static_cast<double>(j) / steps;
      least = std::min(least, length(p - ((1 - u - v) * t[0] + u * t[1] + v * t[2])));
    }
  }
  return least;
}

Vec3 random_point(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

// A patch of a height field over [0, n] x [0, n], heights within `rough`.
std::vector<NamedTriangle> patch(Random& random, std::uint32_t n, double rough) {
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j)
      points.push_back({i * 1.0, j * 1.0, random.uniform(-rough, rough)});
  }
  std::vector<NamedTriangle> result;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    result.push_back({{points[a], points[b], points[c]}, {a, b, c}});
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j;
      add(a, a + n + 1, a + n + 2);
      add(a, a + n + 2, a + 1);
    }
  }
  return result;
}

}  // namespace

TEST_CASE("the distance to a triangle is that of its nearest point, thin triangles included") {
  Random random(5);
  for (int round = 0; round < 300; ++round) {
    std::array<Vec3, 3> t{random_point(random, 1), random_point(random, 1), random_point(random, 1)};
    if (round % 3 == 0) t[2] = t[0] + 0.37 * (t[1] - t[0]) + 1e-9 * random_point(random, 1);
    const Vec3 p = random_point(random, 2);
    const double bound = distance_bound(p, t), sampled = sampled_distance(p, t, 60);
    INFO("round " << round);
    CHECK(bound <= sampled * (1 + 1e-12) + 1e-6);
    CHECK(bound >= sampled - 0.06);  // the grid's spacing
  }
  const std::array<Vec3, 3> t{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};
  CHECK(distance_bound({1, 1, 3}, t) == Approx(3));
  CHECK(distance_bound({-3, -4, 0}, t) == Approx(5));
  CHECK(distance_bound({2, -1, 0}, t) == Approx(1));
  CHECK(distance_bound({4, 4, 0}, t) == Approx(std::sqrt(8)));
}

TEST_CASE("a large triangle over many small ones is covered, however small the distance, unless one is missing") {
  Random random(1);
  const std::vector<NamedTriangle> flat = patch(random, 8, 0);
  const std::array<Vec3, 3> large{Vec3{0, 0, 0}, Vec3{8, 0, 0}, Vec3{8, 8, 0}};
  std::vector<std::uint32_t> used;
  for (const double distance : {1.0, 1e-3, 1e-6}) {
    SurfaceCover cover(distance, 8);
    CHECK(cover.covers(large, flat, used));
    CHECK(used.size() > 30);
    const std::array<Vec3, 3> above{Vec3{0, 0, 0.9 * distance}, Vec3{8, 0, -0.9 * distance}, Vec3{8, 8, 0.5 * distance}};
    CHECK(cover.covers(above, flat, used));
    const std::array<Vec3, 3> higher{Vec3{0, 0, 0}, Vec3{8, 0, 0}, Vec3{8, 8, 1.01 * distance}};
    CHECK_FALSE(cover.covers(higher, flat, used));
  }
  for (std::size_t missing = 0; missing < flat.size(); ++missing) {
    std::vector<NamedTriangle> holed = flat;
    holed.erase(holed.begin() + static_cast<std::ptrdiff_t>(missing));
    const Vec3 middle = 1.0 / 3 * (flat[missing].point[0] + flat[missing].point[1] + flat[missing].point[2]);
    SurfaceCover cover(1e-3, 8);
    CHECK(cover.covers(large, holed, used) == (middle.y > middle.x));
  }
}

TEST_CASE("the cover test is conservative: no point of a passing triangle is farther than the distance") {
  Random random(9);
  int passed = 0, failed = 0;
  for (int round = 0; round < 400; ++round) {
    INFO("round " << round);
    std::vector<NamedTriangle> candidates = patch(random, 3, 0.2);
    for (std::uint32_t gone = random.below(4); gone > 0; --gone)
      candidates.erase(candidates.begin() + random.below(static_cast<std::uint32_t>(candidates.size())));
    std::array<Vec3, 3> t;
    for (Vec3& p : t)
      p = {random.uniform(0.2, 2.8), random.uniform(0.2, 2.8), random.uniform(-0.2, 0.2)};
    const double distance = random.uniform(0.05, 0.5);
    SurfaceCover cover(distance, 3);
    std::vector<std::uint32_t> used;
    const bool is_covered = cover.covers(t, candidates, used);
    (is_covered ? passed : failed)++;
    if (!is_covered) continue;
    double farthest = 0;
    for (int i = 0; i <= 24; ++i) {
      for (int j = 0; i + j <= 24; ++j) {
        const Vec3 p = (1 - (i + j) / 24.0) * t[0] + (i / 24.0) * t[1] + (j / 24.0) * t[2];
        double least = 1e300;
        for (const std::uint32_t c : used)  // the proof rests on these alone
          least = std::min(least, distance_bound(p, candidates[c].point));
        farthest = std::max(farthest, least);
      }
    }
    CHECK(farthest <= distance);
  }
  CHECK(passed > 50);
  CHECK(failed > 50);
}
