// SPDX-License-Identifier: Apache-2.0
#include "hierarchy.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "compiled.hpp"
#include "hilbert.hpp"
#include "meshes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

TEST_CASE("levels halve from one box for four nodes up to one root") {
  CHECK(hierarchy_levels(1) == std::vector<std::uint32_t>{1});
  CHECK(hierarchy_levels(4) == std::vector<std::uint32_t>{1});
  CHECK(hierarchy_levels(5) == std::vector<std::uint32_t>{1, 2});
  CHECK(hierarchy_levels(9) == std::vector<std::uint32_t>{1, 2, 3});
  CHECK(hierarchy_levels(1000000) == std::vector<std::uint32_t>{1, 2, 4, 8, 16, 31, 62, 123, 245, 489, 977, 1954, 3907, 7813,
                                                                15625, 31250, 62500, 125000, 250000});
}

TEST_CASE("boxes hold their nodes at any scale and are no larger than rounding needs") {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const PolygonSoup soup = transformed(star_sphere(3, 0.3, seed), random_rotation(seed), scale);
      const WalkedGraph graph = compile_sound(soup);
      REQUIRE(!graph.boxes.empty());
      for (int k = 0; k < 3; ++k) {
        CHECK(std::fabs(graph.boxes[0].min[k] - graph.header.bounds_min[k]) <= 2e-7 * graph.header.extent);
        CHECK(std::fabs(graph.boxes[0].max[k] - graph.header.bounds_max[k]) <= 2e-7 * graph.header.extent);
      }
    }
  }
}

TEST_CASE("the Hilbert curve visits every cell once, neighbour after neighbour") {
  for (const unsigned bits : {1u, 2u, 4u}) {
    const std::uint32_t n = 1u << bits;
    std::vector<std::array<int, 3>> cells(std::size_t{n} * n * n, {-1, -1, -1});
    for (std::uint32_t x = 0; x < n; ++x) {
      for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t z = 0; z < n; ++z)
          cells[hilbert_position({x, y, z}, bits)] = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
      }
    }
    for (std::size_t i = 1; i < cells.size(); ++i) {
      int distance = 0;
      for (int k = 0; k < 3; ++k)
        distance += std::abs(cells[i][k] - cells[i - 1][k]);
      if (distance != 1) FAIL_CHECK("a jump before position " << i);
    }
  }
}

TEST_CASE("consecutive nodes lie near each other") {
  const WalkedGraph graph = compile_sound(ico_sphere(5));
  const auto centre = [&](const WalkedNode& n) {
    std::array<double, 3> c{};
    for (std::uint32_t s = 0; s < n.side_count; ++s) {
      for (int k = 0; k < 3; ++k)
        c[k] += graph.corners[graph.corner_of_side(n.first_side + s)].point[k] / n.side_count;
    }
    return c;
  };
  double sum = 0;
  for (std::size_t i = 1; i < graph.nodes.size(); ++i) {
    const auto a = centre(graph.nodes[i - 1]), b = centre(graph.nodes[i]);
    sum += std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
  }
  const double edge = std::sqrt(4 * 3.14159 / static_cast<double>(graph.nodes.size()));
  CHECK(sum / static_cast<double>(graph.nodes.size()) < 2 * edge);
}
