// SPDX-License-Identifier: Apache-2.0
#include "graph/regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/vec3.hpp"
#include "catch.hpp"
#include "graph/triangulate.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "topology/topology.hpp"
#include "topology/weld.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

struct Found {
  Triangulation cut;
  std::vector<EdgeClass> edges;
  Regions regions;
  Quantum quantum;
};

Found regions_of(const PolygonSoup& soup, const Coplanar& coplanar = {}) {
  Mesh mesh = weld_points(soup, {}, Precision::f64);
  Topology topology = pair_halfedges(mesh);
  Found found{triangulate(std::move(mesh), std::move(topology)), {}, {}, {}};
  found.quantum = {soup.relative_quantum, soup.absolute_quantum, 0, found.cut.mesh.origin};
  found.edges = classify_edges(found.cut.mesh, found.cut.topology, found.quantum, coplanar, 1);
  found.regions = find_regions(found.cut.mesh, found.cut.topology, found.edges, {coplanar, found.quantum, Precision::f64});
  return found;
}

Vec3 normal_of(const Mesh& mesh, std::uint32_t f) {
  const auto p = [&](std::uint32_t i) { return mesh.points[+mesh.corners[3 * f + i]]; };
  return unit_normal(p(0), p(1), p(2));
}

// The bound that the header promises, face by face.
void check_bounds(const Found& found, double angle) {
  const Mesh& mesh = found.cut.mesh;
  std::vector<double> quantum(found.regions.list.size(), 0);  // the largest in each region
  for (std::uint32_t slot = 0; slot < mesh.corners.size(); ++slot) {
    const std::uint32_t r = found.regions.of(FaceId{slot / 3});
    if (r != kNone) quantum[r] = std::max(quantum[r], found.quantum.at(mesh.points[+mesh.corners[slot]]));
  }
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t r = found.regions.of(FaceId{f});
    if (r == kNone) continue;
    const Region& region = found.regions.list[r];
    bool within_quantum = true;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Vec3& p = mesh.points[+mesh.corners[3 * f + i]];
      const double off = std::fabs(dot(region.plane.normal, p) + region.plane.offset);
      within_quantum = within_quantum && off <= kQuantumReach * quantum[r] * (1 + 1e-9) + 1e-15;
    }
    const bool within_angle = dot(normal_of(mesh, f), region.plane.normal) >= std::cos(angle) - 1e-12;
    const bool is_bounded = within_quantum || (region.tier == Flat::angle && within_angle);
    CHECK(is_bounded);
  }
}

// A quarter of a cylinder in `n` strips.
PolygonSoup arc(int n, double angle) {
  std::vector<Vec3> points;
  std::vector<std::vector<std::uint32_t>> faces;
  for (int i = 0; i <= n; ++i) {
    const double a = angle * i / n;
    points.push_back({std::cos(a), std::sin(a), 0});
    points.push_back({std::cos(a), std::sin(a), 1});
    const auto k = static_cast<std::uint32_t>(2 * i);
    if (i > 0) faces.push_back({k - 2, k, k + 1, k - 1});
  }
  return make_soup("arc", std::move(points), faces);
}

}  // namespace

TEST_CASE("each side of a triangulated cube is one exact region") {
  const Found found = regions_of(subdivided(cube()));
  REQUIRE(found.regions.list.size() == 6);
  for (const Region& region : found.regions.list)
    CHECK(region.is_exact);
}

TEST_CASE("a mesh without flat edges has no regions") {
  const Found found = regions_of(star_sphere(3, 0.2, 1), {Coplanar::Kind::exact, 0});
  CHECK(found.regions.list.empty());
  CHECK(found.regions.of_face.empty());
}

TEST_CASE("a rotated and rounded plane is one region within its quantum") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (const int n : {3, 30, 100}) {
      const Found found = regions_of(rounded_to_float(transformed(plane_jittered(n, seed), random_rotation(seed))));
      CAPTURE(seed, n);
      REQUIRE(found.regions.list.size() == 1);
      CHECK(!found.regions.list[0].is_exact);
      CHECK(found.regions.list[0].tier == Flat::quantum);
      for (const std::uint32_t r : found.regions.of_face)
        CHECK(r == 0);
      check_bounds(found, 0);
    }
  }
}

TEST_CASE("chains of small angles do not drift") {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  const Found found = regions_of(arc(360, 90 * kDegree), {Coplanar::Kind::angle, 1 * kDegree});
  check_bounds(found, 1 * kDegree);
  std::map<std::uint32_t, std::pair<double, double>> range;
  for (std::uint32_t f = 0; f < found.cut.mesh.face_count(); ++f) {
    const Vec3 n = normal_of(found.cut.mesh, f);
    const double a = std::atan2(n.y, n.x);
    auto& [low, high] = range.try_emplace(found.regions.of(FaceId{f}), a, a).first->second;
    low = std::min(low, a);
    high = std::max(high, a);
  }
  CHECK(range.count(kNone) == 0);
  CHECK(range.size() >= 45);
  CHECK(range.size() <= 120);
  for (const auto& [region, ends] : range)
    CHECK(ends.second - ends.first <= 2 * kDegree + 1e-9);
}

TEST_CASE("a curved strip flat within the quantum edge by edge stops at the whole region's plane") {
  PolygonSoup soup = arc(400, 0.5);
  soup.relative_quantum = 0;
  soup.absolute_quantum = 1e-6;
  const Found found = regions_of(soup);
  CHECK(found.regions.list.size() > 10);
  check_bounds(found, 0);
}

TEST_CASE("exactly flat edges never lie between two regions") {
  for (const PolygonSoup& base : {subdivided(l_prism()), plane_jittered(10, 1), subdivided(cone_pit(12))}) {
    for (const double q : {0.0, 1e-7, 1e-3, 1e-2}) {
      PolygonSoup soup = base;
      soup.absolute_quantum = q;
      const Found found = regions_of(soup);
      for (std::uint32_t slot = 0; slot < found.edges.size(); ++slot) {
        if (found.edges[slot].flat() != Flat::exact) continue;
        CHECK(found.regions.of_face[slot / 3] != kNone);
        CHECK(found.regions.of_face[slot / 3] == found.regions.of_face[+found.cut.topology.twin[slot] / 3]);
      }
    }
  }
}

TEST_CASE("by the quantum no faces are joined where more than 32 planes meet in a tip") {
  PolygonSoup soup = triangulated(cone(5000));
  soup.relative_quantum = 0x1p-24;
  const Found found = regions_of(soup);
  const Mesh& mesh = found.cut.mesh;
  const auto is_tip = [&](std::uint32_t slot) { return mesh.points[+mesh.corners[slot]].z == 1; };
  int at_tip = 0, joined = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const bool touches = is_tip(3 * f) || is_tip(3 * f + 1) || is_tip(3 * f + 2);
    const std::uint32_t r = found.regions.of(FaceId{f});
    at_tip += touches;
    joined += touches && r != kNone && !found.regions.list[r].is_exact;
  }
  CHECK(at_tip == 5000);
  CHECK(joined == 0);
}

// Beside the slab of a face so far off its corners the two sides of a thin solid would be one.
TEST_CASE("by the quantum no faces are joined whose corners would lie off by a share of the solid's thickness") {
  for (const double thickness : {1.0, 0.01}) {
    PolygonSoup plate = triangulated(thin_plate(thickness, 4));
    Random random(1);
    for (Vec3& p : plate.points)
      p.z += random.uniform(-1e-3, 1e-3);
    plate.absolute_quantum = 1e-3;
    const Found found = regions_of(plate);
    const bool is_joined = std::any_of(found.regions.list.begin(), found.regions.list.end(),
                                       [](const Region& region) { return region.tier == Flat::quantum; });
    CAPTURE(thickness);
    CHECK(is_joined == (thickness == 1.0));
  }
}
