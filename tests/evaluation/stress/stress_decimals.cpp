// SPDX-License-Identifier: Apache-2.0
#include "stress_decimals.hpp"

#include <algorithm>
#include <cmath>

#include "meshes.hpp"
#include "ring_bodies.hpp"

namespace fdcg::test {
namespace {

// A lathe's work with a wall: outside up, inside down again, each ring nearer to the axis or farther than the last.
PolygonSoup bowl(Random& random) {
  RingBody body(6 + random.below(26));
  constexpr std::uint32_t kMostRings = 7;
  const std::uint32_t rings = 2 + random.below(kMostRings - 1);
  const double wall = random.uniform(0.02, 0.15);
  double radius[kMostRings], z[kMostRings];
  for (std::uint32_t i = 0; i < rings; ++i) {
    radius[i] = random.uniform(0.3, 0.6);
    z[i] = i == 0 ? -0.4 : z[i - 1] + random.uniform(0.05, 0.3);
  }
  std::vector<std::uint32_t> ring;
  for (std::uint32_t i = 0; i < rings; ++i)
    ring.push_back(body.add_ring(radius[i], z[i]));
  for (std::uint32_t i = rings; i-- > 0;)
    ring.push_back(body.add_ring(radius[i] - wall, i == 0 ? z[0] + wall / 8 : z[i]));
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    body.join(ring[i], ring[i + 1], false);
  body.join_to_point(ring.back(), body.add_point(z[0] + wall / 8));
  body.add_floor(Cap::fan, ring.front());
  return body.along(random.below(3));
}

PolygonSoup some_body(Random& random) {
  switch (random.below(12)) {
    case 0:
      return grid_box(3, 2, 2, {1, 0.8, 0.7});
    case 1:
      return corner_pit();
    case 2:
      return l_prism();
    case 3:
      return v_groove(random.uniform(0.05, 3));
    case 4:
      return subdivided(wedge(random.uniform(0.1, 3)), random.bits());
    case 5:
    case 6:
      return star_sphere(2 + static_cast<int>(random.below(3)), random.uniform(0.02, 0.3), random.bits());
    case 7:
    case 8:
      return fan_block(3 + static_cast<int>(random.below(8)), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1),
                       random.uniform(-0.1, 0.1));
    default:
      return bowl(random);
  }
}

constexpr double kLargestShare = 1e-3;  // of the largest coordinate, as of a grid's step: whoever reads the file stops there

double largest_coordinate(const PolygonSoup& soup) {
  double largest = 0;
  for (const Vec3& p : soup.points)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest;
}

}  // namespace

Body decimal_bodies(Random& random, bake::Precision precision) {
  const auto decimals = static_cast<int>(3 + random.below(4));
  const double step = std::pow(10, -decimals);
  PolygonSoup soup = transformed(some_body(random), random_rotation(random.bits()), random.uniform(0.3, 3));
  for (Vec3& p : soup.points)
    p = {std::round(p.x / step) * step, std::round(p.y / step) * step, std::round(p.z / step) * step};
  soup = triangulated(soup, random.bits());
  soup.absolute_quantum = std::min(step / 2, kLargestShare * largest_coordinate(soup));
  Body body;
  body.options.precision = precision;
  body.options.coplanar.kind = bake::Coplanar::Kind::quantum;
  body.options.store_planes = random.chance(0.5);
  body.options.jobs = 1;
  body.options.without = {"source-map", "info"};
  body.description = soup.name + ", turned, of " + std::to_string(decimals) + " decimals" +
                     (body.options.store_planes ? "" : ", planes derived");
  body.soup = std::move(soup);
  return body;
}

}  // namespace fdcg::test
