// SPDX-License-Identifier: Apache-2.0
#include "graph/merge.hpp"

#include <cmath>
#include <set>
#include <tuple>

#include "catch.hpp"
#include "compiled.hpp"
#include "meshes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

using Place = std::tuple<double, double, double>;

std::set<Place> corner_places(const WalkedGraph& graph) {
  std::set<Place> places;
  for (const WalkedCorner& c : graph.corners)
    places.insert(
        {c.point[0] + graph.header.origin[0], c.point[1] + graph.header.origin[1], c.point[2] + graph.header.origin[2]});
  return places;
}

CompileOptions unmerged() {
  CompileOptions options;
  options.merge = false;
  return options;
}

// A block with a square hole through it: eight cubes around a missing one.
PolygonSoup holed_plate() {
  std::vector<std::array<int, 3>> cells;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x != 1 || y != 1) cells.push_back({x, y, 0});
    }
  }
  return voxels("holed plate", cells);
}

// A regular polygon fan in the plane z = 0, with its centre as a vertex.
PolygonSoup disc(std::uint32_t sides) {
  std::vector<Vec3> points{{0, 0, 0}};
  std::vector<std::vector<std::uint32_t>> faces;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / sides;
    points.push_back({std::cos(angle), std::sin(angle), 0});
    faces.push_back({0, i + 1, (i + 1) % sides + 1});
  }
  return make_soup("disc", std::move(points), faces);
}

}  // namespace

TEST_CASE("a plate with a hole is cut into convex nodes around it") {
  for (const PolygonSoup& soup : {holed_plate(), triangulated(holed_plate(), 1), subdivided(subdivided(holed_plate()), 2)}) {
    const WalkedGraph graph = compile_sound(soup);
    CHECK(graph.euler_characteristic() == 0);
    CHECK(graph.corners.size() == 16);
    CHECK(graph.nodes.size() <= 8 + 2 * 4 + 2);
    CHECK(connections_of(graph, FDCG_CONVEX) == 8 + 8 + 4);
    CHECK(connections_of(graph, FDCG_CONCAVE) == 4);
  }
}

TEST_CASE("merging keeps area and Euler characteristic") {
  for (const PolygonSoup& soup : {holed_plate(), subdivided(holed_plate()), l_prism(), subdivided(corner_pit()), cone(100),
                                  grid_box(5, 5, 5, {1, 2, 3}), plane_jittered(20, 1), torus(16, 12), v_groove(0.5)}) {
    const WalkedGraph merged = compile_sound(soup), plain = compile_sound(soup, unmerged());
    INFO(soup.name);
    CHECK(merged.euler_characteristic() == plain.euler_characteristic());
    CHECK(merged.area() == Approx(plain.area()).epsilon(1e-13));
    CHECK(merged.nodes.size() <= plain.nodes.size());
  }
}

TEST_CASE("the corners that remain do not depend on how a region was cut") {
  const auto expected = corner_places(compile_sound(holed_plate()));
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    CHECK(corner_places(compile_sound(triangulated(holed_plate(), seed))) == expected);
    CHECK(corner_places(compile_sound(subdivided(triangulated(holed_plate(), seed), seed))) == expected);
    CHECK(corner_places(compile_sound(triangulated(subdivided(subdivided(holed_plate())), seed))) == expected);
  }
}

TEST_CASE("merging removes float noise on a rotated, finely triangulated plate") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const PolygonSoup fine = subdivided(subdivided(subdivided(holed_plate())));
    const WalkedGraph graph = compile_sound(rounded_to_float(transformed(fine, random_rotation(seed))));
    CAPTURE(seed);
    CHECK(graph.corners.size() == 16);
    CHECK(graph.euler_characteristic() == 0);
    CHECK(connections_of(graph, FDCG_CONVEX) == 20);
    CHECK(connections_of(graph, FDCG_CONCAVE) == 4);
    CHECK(graph.header.max_deviation > 0);
    CHECK(graph.header.max_deviation <= 4 * 1.7321 * graph.header.quantum * 1.01);
  }
}

TEST_CASE("no merged node has more sides than the bound, however many the region has") {
  for (const std::uint32_t sides : {16u, 17u, 500u, 10000u}) {
    const WalkedGraph graph = compile_sound(disc(sides));
    for (const WalkedNode& n : graph.nodes)
      CHECK(n.side_count <= kMaxMergedSides);
    CHECK(graph.nodes.size() <= 2 * (sides / (kMaxMergedSides - 2) + 1));
    CHECK(graph.euler_characteristic() == 1);
    CHECK(graph.corners.size() == sides);
  }
}

TEST_CASE("cones of 500 and 10,000 sides keep their apex and merge their base") {
  for (const int sides : {500, 10000}) {
    const WalkedGraph graph = compile_sound(cone(sides));
    CHECK(graph.euler_characteristic() == 2);
    CHECK(graph.header.largest_fan == static_cast<std::uint32_t>(sides));
    CHECK(graph.nodes.size() < 3u * static_cast<unsigned>(sides));
  }
}

TEST_CASE("thin plates keep both sides") {
  for (const double thickness : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const WalkedGraph graph = compile_sound(subdivided(thin_plate(thickness, 3)));
    CHECK(graph.nodes.size() == 6);
    CHECK(connections_of(graph, FDCG_CONVEX) == 12);
  }
}

TEST_CASE("without merging, faces are kept and still share their region's plane") {
  const WalkedGraph boxes = compile_sound(grid_box(3, 3, 3, {1, 1, 1}), unmerged());
  CHECK(boxes.nodes.size() == 54);
  CHECK(connections_of(boxes, FDCG_COPLANAR) == 72);
  const WalkedGraph noisy =
      compile_sound(rounded_to_float(transformed(grid_box(3, 3, 3, {1, 1, 1}), random_rotation(1))), unmerged());
  CHECK(noisy.nodes.size() == 54);
  std::set<std::tuple<double, double, double, double>> planes;
  for (const WalkedNode& n : noisy.nodes)
    planes.insert({n.plane.normal[0], n.plane.normal[1], n.plane.normal[2], n.plane.offset});
  CHECK(planes.size() == 6);
}

TEST_CASE("polygons that are not convex, not planar or too many-sided are split and counted") {
  const PolygonSoup arrow = make_soup("arrow", {{0, 0, 0}, {2, -1, 0}, {1, 0, 0}, {2, 1, 0}}, {{0, 1, 2, 3}});
  const PolygonSoup bent = make_soup("bent", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}, {{0, 1, 2, 3}});
  for (const bool merge : {false, true}) {
    CompileOptions options;
    options.merge = merge;
    CHECK(compile_whole(arrow, options).split_faces == 1);
    CHECK(compile_sound(arrow, options).nodes.size() == 2);
    CHECK(compile_whole(bent, options).split_faces == 1);
    CHECK(compile_sound(bent, options).nodes.size() == 2);
    CHECK(compile_whole(prism(200), options).split_faces == 2);
    CHECK(compile_whole(prism(16), options).split_faces == 0);
    CHECK(compile_sound(prism(16), options).nodes.size() == 18);
  }
  // A hook whose corners lie in a straight line with others: every ear must still have area.
  const PolygonSoup comb = make_soup("comb",
                                     {{0, 0, 0},
                                      {1, 0, 0},
                                      {2, 0, 0},
                                      {4, 0, 0},
                                      {4, 2, 0},
                                      {3, 2, 0},
                                      {3, 1, 0},
                                      {2, 1, 0},
                                      {1, 1, 0},
                                      {1, 2, 0},
                                      {0, 2, 0},
                                      {0, 1, 0}},
                                     {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}});
  const WalkedGraph graph = compile_sound(comb);
  CHECK(graph.area() == Approx(6));
  CHECK(graph.nodes.size() == 3);
}

TEST_CASE("collinear corners of an open boundary are removed, others are not") {
  std::vector<Vec3> points;
  std::vector<std::vector<std::uint32_t>> faces;
  constexpr std::uint32_t kSteps = 50;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    points.push_back({double(i), 0, 0});
    points.push_back({double(i), 1 + (i == 20 ? 0.5 : 0.0), 0});
    if (i > 0) faces.push_back({2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 1});
  }
  const WalkedGraph graph = compile_sound(make_soup("strip", points, faces));
  CHECK(graph.corners.size() == 4 + 3);
}

TEST_CASE("coplanar islands at different heights do not merge") {
  const WalkedGraph graph = compile_sound(subdivided(voxels("stairs", {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}})));
  CHECK(connections_of(graph, FDCG_CONCAVE) == 1);
  CHECK(graph.euler_characteristic() == 2);
}
