// SPDX-License-Identifier: Apache-2.0
// The guarantees of simplify, measured independently: distances by CGAL's AABB tree, topology by counting.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "random.hpp"
#include "real_meshes.hpp"
#include "repair/simplify.hpp"
#include "soups.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::joined;
using fdcg::test::make_soup;
using fdcg::test::Random;
using fdcg::test::reversed;

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>>>;

Triangles triangles_of(const PolygonSoup& soup) {
  const auto point = [&](std::uint32_t c) {
    const Vec3& p = soup.points[soup.corners[c]];
    return Kernel::Point_3(p.x, p.y, p.z);
  };
  Triangles triangles;
  for (std::uint32_t f = 0; f < soup.face_count(); ++f)
    triangles.emplace_back(point(3 * f), point(3 * f + 1), point(3 * f + 2));
  return triangles;
}

// The farthest of `samples` random points of one surface, and of all its corners, from the other.
double farthest(Triangles& from, Triangles& to, std::size_t samples, Random& random) {
  Tree tree(to.begin(), to.end());
  tree.accelerate_distance_queries();
  double largest = 0;
  const auto measure = [&](const Kernel::Point_3& p) { largest = std::max(largest, tree.squared_distance(p)); };
  for (const Kernel::Triangle_3& t : from) {
    for (int k = 0; k < 3; ++k)
      measure(t[k]);
    measure(CGAL::centroid(t));
  }
  for (std::size_t i = 0; i < samples; ++i) {
    const Kernel::Triangle_3& t = from[random.below(static_cast<std::uint32_t>(from.size()))];
    double u = random.unit(), v = random.unit();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    measure(t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
  }
  return std::sqrt(largest);
}

// Vertices less edges plus faces; vertices at equal coordinates are one.
std::int64_t euler_characteristic(const PolygonSoup& soup) {
  std::map<std::array<double, 3>, int> number;
  std::set<std::pair<int, int>> edges;
  const auto at = [&](std::uint32_t c) {
    const Vec3& p = soup.points[soup.corners[c]];
    return number.try_emplace({p.x + 0.0, p.y + 0.0, p.z + 0.0}, static_cast<int>(number.size())).first->second;
  };
  for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k)
      edges.insert(std::minmax({at(3 * f + k), at(3 * f + (k + 1) % 3)}));
  }
  return static_cast<std::int64_t>(number.size()) - static_cast<std::int64_t>(edges.size()) +
         static_cast<std::int64_t>(soup.face_count());
}

std::map<std::string, std::uint64_t> totals(const Report& report) {
  std::map<std::string, std::uint64_t> result;
  for (const Issue& issue : report.issues)
    result[issue.rule] = issue.total;
  return result;
}

Repaired simplified(const PolygonSoup& soup, double error) {
  RepairOptions options;
  options.simplify_error = error;
  options.jobs = 2;
  const Result<Repaired> result = repair(soup, options);
  REQUIRE(result);
  REQUIRE(result->actions.size() == 1);
  REQUIRE(result->actions[0].name == "simplify");
  return *result;
}

// All guarantees for `r`, simplified from `soup`.
std::size_t check_promises(const PolygonSoup& soup, const Repaired& r, double error, std::size_t samples) {
  INFO(r.actions[0].message << " " << r.actions[0].left_message);
  REQUIRE(r.actions[0].left == 0);
  CHECK(r.actions[0].total == soup.face_count() - r.soup.face_count());
  Triangles before = triangles_of(soup), after = triangles_of(r.soup);
  Random random(7);
  CHECK(farthest(before, after, samples, random) <= error);
  CHECK(farthest(after, before, samples, random) <= error);
  CHECK(euler_characteristic(r.soup) == euler_characteristic(soup));
  CHECK(r.after.components == r.before.components);
  std::map<std::string, std::uint64_t> was = totals(r.before), is = totals(r.after);
  for (const char* rule : {"degenerate-face", "duplicate-face", "non-manifold-edge", "non-manifold-vertex",
                           "winding-inconsistent", "inside-out", "folded-edge"})
    CHECK(is[rule] <= was[rule]);
  CHECK(is["self-intersection"] <= was["self-intersection"]);
  CHECK((is["boundary-edge"] > 0) == (was["boundary-edge"] > 0));
  return r.soup.face_count();
}

std::size_t check_promises(const PolygonSoup& soup, double error, std::size_t samples) {
  return check_promises(soup, simplified(soup, error), error, samples);
}

// n x n quads in two triangles each, at a height; flat where `height` gives 0.
template <class Height>
PolygonSoup sheet(std::uint32_t n, Height height) {
  std::vector<Vec3> points;
  fdcg::test::Faces faces;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j)
      points.push_back({i * 1.0, j * 1.0, height(i, j)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j;
      faces.push_back({a, a + n + 1, a + n + 2});
      faces.push_back({a, a + n + 2, a + 1});
    }
  }
  return make_soup(points, faces);
}

}  // namespace

TEST_CASE("a flat sheet becomes few triangles within any distance, and a crease stays") {
  for (const double error : {1.0, 1e-3, 1e-6}) {
    CHECK(check_promises(sheet(16, [](auto, auto) { return 0.0; }), std::min(error, 0.1), 2000) <= 40);
    CHECK(check_promises(sheet(16, [](auto i, auto) { return i < 8 ? 0.0 : i - 8.0; }), std::min(error, 0.1), 2000) <= 60);
  }
}

TEST_CASE("closed surfaces keep their shape within the distance, from both sides") {
  const PolygonSoup sphere = bumpy_sphere(40, 60);
  std::size_t last = sphere.face_count();
  for (const double error : {5e-3, 2e-2, 1e-1}) {
    INFO("error " << error);
    const std::size_t faces = check_promises(sphere, error, 5000);
    CHECK(faces < last);
    last = faces;
  }
  CHECK(last < 300);
  // Two parts stay two, and a cavity stays a cavity, though the distance is larger than the wall.
  const PolygonSoup hollow = joined(bumpy_sphere(20, 24, 0), [] {
    PolygonSoup inner = reversed(bumpy_sphere(20, 24, 0));
    for (Vec3& p : inner.points)
      p = {0.97 * p.x, 0.97 * p.y, 0.97 * p.z};
    return inner;
  }());
  check_promises(hollow, 0.05, 3000);
}

TEST_CASE("simplify: a mesh that is no oriented triangle manifold is left, with the reason") {
  const auto reason = [](const PolygonSoup& soup) {
    const Repaired r = simplified(soup, 0.1);
    CHECK(r.actions[0].total == 0);
    CHECK(r.actions[0].left == soup.face_count());
    CHECK(r.soup.corners == soup.corners);
    return r.actions[0].left_message;
  };
  CHECK(reason(cube()).find("face 0 has 4 corners") != std::string::npos);
  PolygonSoup flipped = bumpy_sphere(5, 6);
  std::swap(flipped.corners[3], flipped.corners[4]);
  CHECK(reason(flipped).find("wound against") != std::string::npos);
  PolygonSoup crowded = bumpy_sphere(5, 6);
  crowded.corners.insert(crowded.corners.end(), {0, 1, 9});
  crowded.face_first.push_back(crowded.face_first.back() + 3);
  CHECK(reason(crowded).find("more than two faces") != std::string::npos);
  PolygonSoup pinched = joined(bumpy_sphere(5, 6), bumpy_sphere(5, 6));
  const std::uint32_t points = static_cast<std::uint32_t>(pinched.points.size()) / 2;
  for (std::uint32_t v = points; v < 2 * points; ++v)
    pinched.points[v].z += 2;
  CHECK(reason(pinched).find("more than one fan") != std::string::npos);
}

TEST_CASE("simplify: an error that is not a positive number is refused") {
  for (const double error : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    RepairOptions options;
    options.simplify_error = error;
    const Result<Repaired> result = repair(cube(), options);
    REQUIRE_FALSE(result);
    CHECK(result.error().exit_code == 2);
  }
}

TEST_CASE("simplify: a distance below double precision changes nothing") {
  const PolygonSoup sphere = bumpy_sphere(10, 12);
  CHECK(simplified(sphere, 1e-12).soup.corners == sphere.corners);
}

TEST_CASE("simplify: every guarantee holds on real meshes") {
  const char* asked = std::getenv("FDCG_SIMPLIFY_FACES");  // of the largest mesh to be tried
  const std::size_t largest = asked != nullptr ? std::strtoul(asked, nullptr, 10) : 6000;
  std::size_t found = 0, checked = 0, faces_before = 0, faces_after = 0;
  for (const PolygonSoup& soup : fdcg::test::real_meshes()) {
    ++found;
    if (soup.face_count() > largest) continue;
    bool is_triangles = true;
    Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (std::size_t f = 0; f < soup.face_count(); ++f)
      is_triangles &= soup.face_first[f + 1] == 3 * (f + 1);
    for (const Vec3& p : soup.points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double error = 2e-3 * std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
    if (!is_triangles || !std::isfinite(error) || error == 0) continue;  // all points one: no error to allow
    INFO(soup.name);
    const Repaired r = simplified(soup, error);
    if (r.actions[0].left != 0) continue;
    ++checked;
    faces_before += soup.face_count();
    faces_after += check_promises(soup, r, error, 5000);
  }
  WARN("real meshes: " << found << " found, " << checked << " simplified, " << faces_before << " -> " << faces_after
                       << " faces");
  if (checked > 0) CHECK(faces_after < faces_before);
}

TEST_CASE("an error near the size of a body never turns it inside out") {
  // Long and thin, as most parts that one simplifies too far.
  for (const std::uint32_t rings : {6u, 9u, 14u, 20u}) {
    PolygonSoup body = bumpy_sphere(rings, 11);
    for (Vec3& p : body.points)
      p = {p.x, 0.05 * p.y, 0.02 * p.z};
    for (const double error : {0.03, 0.1, 0.3, 1.0, 3.0}) {
      CAPTURE(rings, error);
      RepairOptions options;
      options.simplify_error = error;
      const auto repaired = repair(body, options);
      REQUIRE(repaired);
      CHECK(repaired->after.passes());
      CHECK(repaired->soup.face_count() < body.face_count());
    }
  }
}
