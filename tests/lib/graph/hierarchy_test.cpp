// SPDX-License-Identifier: Apache-2.0
#include "graph/hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/hilbert.hpp"
#include "catch.hpp"
#include "compiled.hpp"
#include "meshes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

struct Bounds {
  double low[3], high[3];
};

// Box j of a record, in the file's units.
Bounds bounds_of(const WalkedGraph& graph, const fdcg_box8& boxes, std::size_t j) {
  const double unit = std::exp2(std::floor(std::log2(graph.header.extent)));
  Bounds bounds{};
  for (int k = 0; k < 3; ++k) {
    const double cell = std::exp2(boxes.exponent[k] - 127);
    bounds.low[k] = (boxes.origin[k] + cell * boxes.low[k][j]) * unit;
    bounds.high[k] = (boxes.origin[k] + cell * boxes.high[k][j]) * unit;
  }
  return bounds;
}

}  // namespace

TEST_CASE("levels shrink eightfold from one box for four nodes up to one record") {
  CHECK(hierarchy_levels(1) == std::vector<std::uint32_t>{1});
  CHECK(hierarchy_levels(32) == std::vector<std::uint32_t>{1});
  CHECK(hierarchy_levels(33) == std::vector<std::uint32_t>{1, 2});
  CHECK(hierarchy_levels(257) == std::vector<std::uint32_t>{1, 2, 9});
  CHECK(hierarchy_levels(1000000) == std::vector<std::uint32_t>{1, 8, 62, 489, 3907, 31250});
}

TEST_CASE("boxes hold their nodes at any scale and precision and are little larger than they must") {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      for (const Precision precision : {Precision::f64, Precision::f32}) {
        const PolygonSoup soup = transformed(star_sphere(3, 0.3, seed), random_rotation(seed), scale);
        CompileOptions options;
        options.precision = precision;
        const WalkedGraph graph = compile_sound(soup, options);
        REQUIRE(!graph.boxes.empty());
        for (int k = 0; k < 3; ++k) {
          const double size = graph.header.bounds_max[k] - graph.header.bounds_min[k];
          double low = 1e300, high = -1e300;
          for (std::size_t j = 0; j < 8 && graph.boxes[0].low[k][j] <= graph.boxes[0].high[k][j]; ++j) {
            low = std::min(low, bounds_of(graph, graph.boxes[0], j).low[k]);
            high = std::max(high, bounds_of(graph, graph.boxes[0], j).high[k]);
          }
          CHECK(graph.header.bounds_min[k] - low <= size / 20);
          CHECK(high - graph.header.bounds_max[k] <= size / 20);
        }
      }
    }
  }
}

TEST_CASE("flat, needle-like, far and huge meshes have valid boxes") {
  for (const PolygonSoup& soup : {plane_grid(9, 7), thin_plate(1e-9, 5), moved(needle_strip(100, 0.3, 2), {1e6, -1e6, 0}),
                                  scaled(torus(20, 12), 1e30), scaled(torus(20, 12), 1e-30), cone(500)}) {
    CHECK(!compile_sound(soup).boxes.empty());
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
