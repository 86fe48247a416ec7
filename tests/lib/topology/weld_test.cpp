// SPDX-License-Identifier: Apache-2.0
#include "topology/weld.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include "catch.hpp"
#include "soups.hpp"

using namespace fdcg::bake;
using fdcg::test::make_soup;

namespace {

const Weld kExact{Weld::Kind::exact, 0};
const Weld kNoWeld{Weld::Kind::none, 0};

PolygonSoup points_only(std::vector<Vec3> points) {
  return make_soup(std::move(points), {});
}

}  // namespace

TEST_CASE("an object far away is moved to its centre, axis by axis, without rounding") {
  const double far = 1e6;
  PolygonSoup soup = points_only({{far + 0.1, -1, 5}, {far + 0.7, 2, 5}, {far + 0.3, 0, 5}});
  const Mesh mesh = weld_points(soup, kExact, Precision::f64);
  CHECK(mesh.origin.x == Approx(far + 0.4));
  CHECK(mesh.origin.y == 0);
  CHECK(mesh.origin.z == 5);
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    CHECK(mesh.points[i].x + mesh.origin.x == soup.points[i].x);  // exact both ways
    CHECK(static_cast<long double>(mesh.points[i].x) ==
          static_cast<long double>(soup.points[i].x) - static_cast<long double>(mesh.origin.x));
    CHECK(mesh.points[i].y == soup.points[i].y);
    CHECK(mesh.points[i].z == 0);
  }
}

TEST_CASE("the origin is the centre exactly from three half extents on") {
  CHECK(weld_points(points_only({{2, 2 - 0x1p-20, -4}, {4, 4, -2}}), kExact, Precision::f64).origin == Vec3{3, 0, -3});
}

TEST_CASE("non-finite coordinates neither move the origin nor are they joined") {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const Mesh mesh =
      weld_points(points_only({{8, 0, 0}, {nan, 0, 0}, {nan, 0, 0}, {inf, 0, 0}, {inf, 0, 0}, {8, 0, 0}, {8, -inf, 0}}), kExact,
                  Precision::f64);
  CHECK(mesh.origin == Vec3{8, 0, 0});
  CHECK(mesh.points.size() == 6);
  CHECK(mesh.joined_vertices == 1);
  CHECK(mesh.source_point == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 6});
}

TEST_CASE("minus zero and zero are one vertex, a unit in the last place apart are two") {
  const PolygonSoup soup = points_only({{0.0, 1, -1}, {-0.0, 1, -1}, {std::nextafter(0.0, 1.0), 1, -1}, {1, -1, 1}});
  const Mesh mesh = weld_points(soup, kExact, Precision::f64);
  CHECK(mesh.source_point == std::vector<std::uint32_t>{0, 2, 3});
  CHECK_FALSE(std::signbit(weld_points(points_only({{-0.0, 1, 1}, {1, -1, -1}}), kExact, Precision::f64).points[0].x));
}

TEST_CASE("single precision rounds local coordinates and joins those that become equal") {
  const PolygonSoup soup = points_only({{0.1, 1, -1}, {0.1 + 1e-12, 1, -1}, {-0.1, -1, 1}, {1e300, -1, 1}});
  const Mesh mesh = weld_points(soup, kExact, Precision::f32);
  REQUIRE(mesh.points.size() == 3);
  CHECK(mesh.joined_vertices == 1);
  for (const Vec3& p : mesh.points)
    CHECK((static_cast<double>(static_cast<float>(p.y)) == p.y));
  CHECK(std::isinf(mesh.points[2].x));  // out of range: validate reports it
  CHECK(weld_points(soup, kNoWeld, Precision::f32).points.size() == 4);
}

TEST_CASE("corners refer to the joined vertices, and invalid ones are marked") {
  PolygonSoup soup = make_soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, -1, 1}}, {{0, 1, 2}, {2, 3, 4}, {0, 1, 5}});
  soup.corners[0] = PolygonSoup::kInvalidVertex;
  const Mesh mesh = weld_points(soup, kExact, Precision::f64);
  const auto id = [](std::uint32_t v) { return VertexId{v}; };
  CHECK(mesh.corners == std::vector<VertexId>{id(kNone), id(1), id(2), id(2), id(1), id(3), id(0), id(1), id(kNone)});
  CHECK(mesh.face_first == soup.face_first);
  CHECK(mesh.source_face.empty());
}

TEST_CASE("the exact weld agrees with an ordered map on random points of few distinct values") {
  std::mt19937 rng(20240611);
  for (const std::size_t count : {1U, 31U, 32U, 33U, 1000U, 50000U}) {
    for (const Format format : {Format::obj, Format::stl}) {  // the latter starts with a small table, which must grow
      std::vector<Vec3> points(count);
      std::uniform_int_distribution<int> digit(-20, 20);
      for (Vec3& p : points)
        p = {digit(rng) * 0.1, digit(rng) * 1e-3, digit(rng) * 7.0};
      PolygonSoup soup = points_only(points);
      soup.format = format;
      const Mesh mesh = weld_points(soup, kExact, Precision::f64);

      std::map<std::tuple<double, double, double>, std::uint32_t> seen;
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < count; ++i) {
        if (seen.emplace(std::tuple{points[i].x, points[i].y, points[i].z}, i).second) expected.push_back(i);
      }
      CHECK(mesh.source_point == expected);
      CHECK(mesh.joined_vertices == count - expected.size());
    }
  }
}

TEST_CASE("a weld by distance joins each point to the first kept vertex within it, as brute force does") {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (const double distance : {0.01, 0.1, 0.5, 10.0}) {
    std::vector<Vec3> points(500);
    for (Vec3& p : points)
      p = {coordinate(rng), coordinate(rng), coordinate(rng)};
    const Mesh mesh = weld_points(points_only(points), {Weld::Kind::distance, distance}, Precision::f64);
    std::vector<std::uint32_t> standing;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const bool joined = std::any_of(standing.begin(), standing.end(), [&](std::uint32_t s) {
        return std::hypot(points[i].x - points[s].x, points[i].y - points[s].y, points[i].z - points[s].z) <= distance;
      });
      if (!joined) standing.push_back(i);
    }
    CHECK(mesh.source_point == standing);
    CHECK(mesh.joined_vertices == points.size() - standing.size());
  }
}

TEST_CASE("a weld by distance 0 is the exact one; points exactly the distance apart are joined") {
  const PolygonSoup soup = points_only({{-3, 0, 0}, {-2, 0, 0}, {-1, 0, 0}, {0, 0, 0}, {-0.0, 0, 0}, {3, 3, 3}});
  CHECK(weld_points(soup, {Weld::Kind::distance, 0}, Precision::f64).points.size() == 5);
  // -3 takes -2; -1 stands on its own, takes 0: no chain
  CHECK(weld_points(soup, {Weld::Kind::distance, 1}, Precision::f64).source_point == std::vector<std::uint32_t>{0, 2, 5});
}

TEST_CASE("an empty soup makes an empty mesh") {
  const Mesh mesh = weld_points(PolygonSoup{}, kExact, Precision::f64);
  CHECK(mesh.points.empty());
  CHECK(mesh.face_count() == 0);
}
