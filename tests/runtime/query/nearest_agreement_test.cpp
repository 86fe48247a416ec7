// SPDX-License-Identifier: Apache-2.0
// Distances, sides and rays against CGAL, and how long a nearest point takes on a million faces. FDCG_QUERIES in the
// environment sets the number of queries of each mesh.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "compiled.hpp"
#include "fdcg/query.h"
#include "meshes.hpp"
#include "nearest_judge.hpp"
#include "random.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

int query_count() {
  const char* const given = std::getenv("FDCG_QUERIES");
  return given != nullptr ? std::atoi(given) : 20000;
}

struct Opened {
  bake::Compiled compiled;
  fdcg_graph graph{};
  explicit Opened(const bake::PolygonSoup& soup) : compiled(compile_whole(soup)) {
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_TRUSTED, &graph, &error) == FDCG_OK);
  }
};

// Around the body, close to its surface, and at its corners, edges and middles.
bake::Vec3 place_for(const bake::PolygonSoup& soup, double size, Random& random, int i) {
  if (i % 3 == 0) return {size * random.uniform(-2, 2), size * random.uniform(-2, 2), size * random.uniform(-2, 2)};
  const std::size_t f = std::min(soup.face_count() - 1, static_cast<std::size_t>(random.unit() * double(soup.face_count())));
  const std::uint32_t* const c = &soup.corners[soup.face_first[f]];
  double a = random.unit(), b = random.unit();
  if (a + b > 1) a = 1 - a, b = 1 - b;
  if (i % 7 == 0) a = b = 0;
  if (i % 11 == 0) b = 0;
  const bake::Vec3 p = soup.points[c[0]], q = soup.points[c[1]], r = soup.points[c[2]], d = random.direction();
  const double off = size * std::pow(10, random.uniform(-12, 0));
  const auto at = [&](double x, double y, double z, double out) { return x + a * (y - x) + b * (z - x) + off * out; };
  return {at(p.x, q.x, r.x, d.x), at(p.y, q.y, r.y, d.y), at(p.z, q.z, r.z, d.z)};
}

}  // namespace

TEST_CASE(
    "nearest: signed distances are CGAL's within 4 eps of the extent or of themselves, and rays from inside meet the mesh") {
  for (const bake::PolygonSoup& soup : {ico_sphere(5), star_sphere(5, 0.6, 3), spiky_sphere(4, 1, 5),
                                        triangulated(saddle_block()), triangulated(cone(300)), torus(60, 30)}) {
    const bake::PolygonSoup triangles = triangulated(soup);
    const Opened body(triangles);
    const NearestJudge judge(triangles);
    const double extent = body.graph.header->extent, tolerance = 4 * 0x1p-52 * extent;
    const double* const origin = body.graph.header->origin;
    CAPTURE(soup.name);
    Random random(17);
    double worst = 0, worst_share = 0;  // the second: of the extent, or of the distance where that is larger
    int wrong_sides = 0, missed = 0, inside = 0;
    for (int i = 0; i < query_count(); ++i) {
      bake::Vec3 p = place_for(triangles, extent, random, i);
      p = {p.x + origin[0], p.y + origin[1], p.z + origin[2]};
      const double at[3] = {p.x, p.y, p.z};
      double found = 0;
      fdcg_error error;
      REQUIRE(fdcg_get_signed_distance(&body.graph, at, &found, &error) == FDCG_OK);
      const double truth = judge.distance(p);
      const double error_m = std::abs(std::abs(found) - truth);
      worst = std::max(worst, error_m);
      worst_share = std::max(worst_share, error_m / std::max(extent, truth));
      const bool is_inside = judge.is_inside(p);
      if (truth > tolerance && (found < 0) != is_inside) ++wrong_sides;
      if (!is_inside || truth <= tolerance) continue;
      ++inside;
      const bake::Vec3 d = random.direction();
      const double direction[3] = {d.x, d.y, d.z};
      fdcg_surface_hit hit = fdcg_make_surface_hit();
      if (fdcg_cast_ray(&body.graph, at, direction, HUGE_VAL, &hit, &error) != FDCG_OK || hit.side != -1) ++missed;
    }
    std::cout << soup.name << ": " << query_count() << " queries, " << inside << " inside, distances off by at most "
              << worst / (0x1p-52 * extent) << " eps of the extent\n";
    CHECK(worst_share <= 4 * 0x1p-52);
    CHECK(wrong_sides == 0);
    CHECK(missed == 0);
    CHECK(inside > query_count() / 100);
  }
}

TEST_CASE("nearest: on a million faces a point near the surface takes microseconds") {
  const Opened sphere(geodesic_sphere(224));
  REQUIRE(sphere.graph.header->node_count > 1'000'000);
  Random random(23);
  std::vector<double> took_us;
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  fdcg_error error;
  bake::Vec3 d = random.direction();
  for (int i = 0; i < 20000; ++i) {  // a hand that wanders over it, so that the place is warm
    const bake::Vec3 way = random.direction();
    d = {d.x + 1e-3 * way.x, d.y + 1e-3 * way.y, d.z + 1e-3 * way.z};
    const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), r = random.uniform(0.99, 1.01) / length;
    const double at[3] = {r * d.x, r * d.y, r * d.z};
    const auto begin = std::chrono::steady_clock::now();
    REQUIRE(fdcg_find_nearest(&sphere.graph, at, HUGE_VAL, &hit, &error) == FDCG_OK);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
    took_us.push_back(took.count());
  }
  std::nth_element(took_us.begin(), took_us.begin() + 10000, took_us.end());
  std::cout << "nearest on " << sphere.graph.header->node_count << " faces: median " << took_us[10000] << " us\n";
  CHECK(took_us[10000] < 20);  // the bar is 2, alone on a machine
}
