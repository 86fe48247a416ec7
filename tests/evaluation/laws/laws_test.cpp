// SPDX-License-Identifier: Apache-2.0
// What the laws are judged by: the split of a force into what presses and what friction bears, and the formulas of the shapes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "compiled.hpp"
#include "coulomb_load.hpp"
#include "loop_refined.hpp"
#include "ramp.hpp"
#include "smooth_shape.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// The groove's bottom: turned faces meet in concave edges by a rounding too.
std::uint32_t sharpest_concave_edge(const ReferenceSurface<Wide>& surface) {
  std::uint32_t sharpest = FDCG_NONE;
  Wide least = 1;
  for (std::uint32_t e = 0; e < surface.edges.size(); ++e) {
    const auto& edge = surface.edges[e];
    if (edge.type != FDCG_CONCAVE) continue;
    const Wide turn = dot(surface.faces[edge.face[0]].normal, surface.faces[edge.face[1]].normal);
    if (turn < least) least = turn, sharpest = e;
  }
  REQUIRE(sharpest != FDCG_NONE);
  return sharpest;
}

WidePoint placed(const Ramp& ramp, double x, double y, double z) {
  const Hip p = ramp.place(x, y, z);
  return {p[0], p[1], p[2]};
}

}  // namespace

TEST_CASE("a face bears the force along its normal and friction the rest, whichever way it is turned") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Ramp ramp({RampKind::face}, fdcg::bake::Precision::f64, seed);
    const CoulombLoad load = coulomb_load(ramp.surface(), FDCG_FACE, 0, placed(ramp, 3, -4, 2), FDCG_EDGE_WEDGE);
    CHECK(load.is_borne);
    CHECK(static_cast<double>(load.normal) == Approx(2).epsilon(1e-14));
    CHECK(static_cast<double>(load.tangential) == Approx(5).epsilon(1e-14));
    // A force that is off by 2e-12 of its tangential part is told from one that is not.
    const CoulombLoad off =
        coulomb_load(ramp.surface(), FDCG_FACE, 0, placed(ramp, 3 * (1 + 2e-12), -4 * (1 + 2e-12), 2), FDCG_EDGE_WEDGE);
    CHECK(static_cast<double>(off.ratio() - load.ratio()) > 1e-12);
  }
}

TEST_CASE("friction that pulls beside the slip, or along it, is told from friction against it") {
  const Ramp ramp({RampKind::face}, fdcg::bake::Precision::f64, 3);
  const auto off = [&](double x, double y) {
    return static_cast<double>(off_the_slip(ramp.surface(), FDCG_FACE, 0, placed(ramp, x, y, 2), placed(ramp, 6, -8, 2), 2));
  };
  CHECK(off(3, -4) < 1e-15);
  CHECK(off(0, 0) < 1e-15);        // none at all
  CHECK(off(-3, 4) == Approx(5));  // ten newtons off of two that press
  CHECK(off(3 - 4e-12, -4 - 3e-12) == Approx(2.5e-12).epsilon(1e-3));
  const Ramp groove({RampKind::groove, 60}, fdcg::bake::Precision::f64, 5);
  const std::uint32_t edge = sharpest_concave_edge(groove.surface());
  const auto along = [&](double x) {
    return static_cast<double>(
        off_the_slip(groove.surface(), FDCG_EDGE, edge, placed(groove, x, 0, 2), placed(groove, 3, 0, 2), 2));
  };
  CHECK(along(1) < 1e-15);
  CHECK(along(-1) == Approx(1));
}

TEST_CASE("the walls of a groove bear by its opening, the paper's load is what lies across") {
  for (const double opening : {30.0, 60.0, 90.0, 150.0}) {
    const Ramp ramp({RampKind::groove, opening}, fdcg::bake::Precision::f64, 5);
    const std::uint32_t edge = sharpest_concave_edge(ramp.surface());
    const WidePoint straight = placed(ramp, 7, 0, 2);
    const double half = opening / 2 * kDegree;
    const CoulombLoad wedge = coulomb_load(ramp.surface(), FDCG_EDGE, edge, straight, FDCG_EDGE_WEDGE);
    CHECK(static_cast<double>(wedge.normal) == Approx(2 / std::sin(half)).epsilon(1e-13));
    CHECK(static_cast<double>(wedge.tangential) == Approx(7).epsilon(1e-13));
    const CoulombLoad paper = coulomb_load(ramp.surface(), FDCG_EDGE, edge, straight, FDCG_EDGE_PAPER);
    CHECK(static_cast<double>(paper.normal) == Approx(2).epsilon(1e-13));
    // One wall alone: its normal's own force is borne whole.
    const WidePoint on_one_wall = placed(ramp, 0, std::cos(half) * 3, std::sin(half) * 3);
    const CoulombLoad one = coulomb_load(ramp.surface(), FDCG_EDGE, edge, on_one_wall, FDCG_EDGE_WEDGE);
    CHECK(static_cast<double>(one.normal) == Approx(3).epsilon(1e-13));
  }
}

TEST_CASE("convex edges, corners and free space bear nothing") {
  const Ramp ramp({RampKind::convex_edges, 120, 6}, fdcg::bake::Precision::f64, 1);
  const WidePoint force = {1, 2, 3};
  for (std::uint32_t e = 0; e < ramp.surface().edges.size(); ++e) {
    if (ramp.surface().edges[e].type == FDCG_CONVEX)
      CHECK_FALSE(coulomb_load(ramp.surface(), FDCG_EDGE, e, force, FDCG_EDGE_WEDGE).is_borne);
  }
  CHECK_FALSE(coulomb_load(ramp.surface(), FDCG_VERTEX, 0, force, FDCG_EDGE_WEDGE).is_borne);
  CHECK_FALSE(coulomb_load(ramp.surface(), FDCG_FREE, FDCG_NONE, force, FDCG_EDGE_WEDGE).is_borne);
}

TEST_CASE("a smooth shape's formulas agree with one another and with its tessellations' corners") {
  for (const SmoothShape* shape : smooth_shapes()) {
    INFO(shape->name());
    for (const Vec3& p : shape->tessellated(2).points)
      REQUIRE(std::abs(shape->distance({p.x, p.y, p.z})) < 1e-16L);
    for (int i = 0; i < 200; ++i) {
      const SurfacePoint at = shape->curve(0.37L * i);
      REQUIRE(std::abs(shape->distance(at.point)) < 1e-18L);
      REQUIRE(std::abs(length(at.normal) - 1) < 1e-18L);
      // Along the normal the distance grows as the way, up to the curvature's centre on the way in.
      const long double depth = 0.3L * static_cast<long double>(shape->curvature_radius_m());
      REQUIRE(std::abs(shape->distance(at.point - at.normal * depth) + depth) < 1e-17L);
      REQUIRE(std::abs(shape->distance(at.point + at.normal * depth) - depth) < 1e-17L);
    }
  }
}

TEST_CASE("a tetrahedron refined after Loop is a quarter of itself") {  // each vertex and each edge's middle, by its weights
  bake::PolygonSoup soup;
  soup.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  soup.corners = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
  soup.face_first = {0, 3, 6, 9, 12};
  const bake::PolygonSoup refined = loop_refined(soup);
  REQUIRE(refined.points.size() == 10);
  REQUIRE(refined.face_first.size() == 17);
  for (std::size_t v = 0; v < 4; ++v) {
    CHECK(refined.points[v].x == Approx(soup.points[v].x / 4));
    CHECK(refined.points[v].y == Approx(soup.points[v].y / 4));
    CHECK(refined.points[v].z == Approx(soup.points[v].z / 4));
  }
  for (std::size_t v = 4; v < 10; ++v) {  // a quarter of the ends' sum, on an axis
    const bake::Vec3& p = refined.points[v];
    CHECK(std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) == Approx(0.5));
    CHECK(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) == Approx(0.5));
  }
  // without a face its edges have one face each: their ends stay, and the new ones are their middles
  soup.corners.resize(9);
  soup.face_first.pop_back();
  const bake::PolygonSoup open = loop_refined(soup);
  for (std::size_t v = 1; v < 4; ++v)
    CHECK(open.points[v].x == soup.points[v].x);
  compile_whole(refined);
}
