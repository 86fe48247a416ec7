// SPDX-License-Identifier: Apache-2.0
#include "graph/classify.hpp"

#include <gmpxx.h>

#include <cmath>

#include "base/vec3.hpp"
#include "catch.hpp"
#include "graph/triangulate.hpp"
#include "meshes.hpp"
#include "real_meshes.hpp"
#include "topology/topology.hpp"
#include "topology/weld.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

struct Classified {
  Triangulation cut;
  std::vector<EdgeClass> edges;
};

Classified classified(const PolygonSoup& soup, const Coplanar& coplanar = {}, Precision precision = Precision::f64) {
  Mesh mesh = weld_points(soup, {}, precision);
  Topology topology = pair_halfedges(mesh);
  Classified result{triangulate(std::move(mesh), std::move(topology)), {}};
  const Quantum quantum{soup.relative_quantum, soup.absolute_quantum, precision == Precision::f32 ? 0x1p-24 : 0,
                        result.cut.mesh.origin};
  result.edges = classify_edges(result.cut.mesh, result.cut.topology, quantum, coplanar, 2);
  return result;
}

const Vec3& point(const Mesh& mesh, std::uint32_t slot) {
  return mesh.points[+mesh.corners[slot]];
}
std::uint32_t apex(std::uint32_t slot) {
  return slot % 3 == 0 ? slot + 2 : slot - 1;
}
std::uint32_t following(std::uint32_t slot) {
  return slot % 3 == 2 ? slot - 2 : slot + 1;
}

// By rational arithmetic on the stored points.
int exact_sign(const Mesh& mesh, std::uint32_t slot, std::uint32_t twin) {
  const Vec3 &o = point(mesh, slot), &a = point(mesh, following(slot)), &b = point(mesh, apex(slot)),
             &c = point(mesh, apex(twin));
  const auto d = [&](const Vec3& p) {
    return std::array<mpq_class, 3>{mpq_class(p.x) - mpq_class(o.x), mpq_class(p.y) - mpq_class(o.y),
                                    mpq_class(p.z) - mpq_class(o.z)};
  };
  const auto u = d(a), v = d(b), w = d(c);
  const mpq_class determinant =
      (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
  return sgn(determinant);
}

// Returns how many edges were compared.
std::size_t check_signs(const Classified& c) {
  std::size_t edges = 0;
  for (std::uint32_t slot = 0; slot < c.edges.size(); ++slot) {
    const HalfedgeId twin = c.cut.topology.twin[slot];
    if (twin == Topology::kBoundary) {
      CHECK(c.edges[slot].sign() == FDCG_BOUNDARY);
      continue;
    }
    if (+twin < slot) continue;
    const int sign = exact_sign(c.cut.mesh, slot, +twin);
    const fdcg_connection_type expected = sign < 0 ? FDCG_CONVEX : sign > 0 ? FDCG_CONCAVE : FDCG_COPLANAR;
    if (c.edges[slot].sign() != expected || c.edges[+twin] != c.edges[slot]) FAIL_CHECK("wrong sign at half-edge " << slot);
    if (sign != 0 && c.edges[slot].flat() == Flat::exact) FAIL_CHECK("wrongly flat at half-edge " << slot);
    ++edges;
  }
  return edges;
}

// Two unit right triangles along a hinge, the second turned up by `angle` (concave when positive).
PolygonSoup hinge(double angle) {
  return make_soup("hinge", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -std::cos(angle), std::sin(angle)}}, {{0, 1, 2}, {1, 0, 3}});
}

EdgeClass hinge_class(const PolygonSoup& soup, const Coplanar& coplanar) {
  return classified(soup, coplanar).edges[0];
}

}  // namespace

TEST_CASE("signs equal rational arithmetic on near-flat and on rounded meshes") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Rotation turn = random_rotation(seed);
    for (const PolygonSoup& soup :
         {plane_jittered(20, seed), rounded_to_float(transformed(plane_jittered(20, seed), turn)),
          transformed(plane_grid(20, 20), turn, 1e-3, {10, 20, 30}),
          rounded_to_float(transformed(grid_box(8, 8, 8, {1, 1, 1}), turn)), star_sphere(3, 0.2, seed),
          needle_strip(300, 1e-12, seed), transformed(thin_plate(1e-13, 6), turn)}) {
      for (const Precision precision : {Precision::f64, Precision::f32})
        check_signs(classified(soup, {Coplanar::Kind::exact, 0}, precision));
    }
  }
}

TEST_CASE("signs survive very large and very small coordinates") {
  for (const double scale : {1e-120, 1e-60, 1e60, 1e90})
    check_signs(classified(scaled(star_sphere(2, 0.3, 1), scale), {Coplanar::Kind::exact, 0}));
}

TEST_CASE("signs equal rational arithmetic on every edge of the real meshes available") {
  std::size_t meshes = 0, edges = 0;
  for (const PolygonSoup& soup : real_meshes()) {
    const auto report = validate(soup);
    bool is_manifold = true;
    for (const Issue& issue : report.issues)
      is_manifold = is_manifold && (issue.severity != Severity::error || issue.rule == "inside-out");
    if (!is_manifold) continue;
    INFO(soup.name);
    edges += check_signs(classified(soup, {Coplanar::Kind::exact, 0}));
    ++meshes;
  }
  WARN("real meshes: " << meshes << ", edges: " << edges);
}

TEST_CASE("edge classes: the three tiers at a hinge") {
  const Coplanar exact{Coplanar::Kind::exact, 0}, quantum{}, degree{Coplanar::Kind::angle, 0.0174533};
  const auto with_quantum = [](PolygonSoup soup, double q) {
    soup.relative_quantum = 0;
    soup.absolute_quantum = q;
    return soup;
  };
  CHECK(hinge_class(hinge(0), exact) == EdgeClass(FDCG_COPLANAR, Flat::exact));
  CHECK(hinge_class(hinge(1e-9), exact) == EdgeClass(FDCG_CONCAVE, Flat::no));
  CHECK(hinge_class(hinge(-1e-9), exact) == EdgeClass(FDCG_CONVEX, Flat::no));
  // Altitude of the tetrahedron: sin(1e-6) against 4 sqrt(3) q.
  CHECK(hinge_class(with_quantum(hinge(1e-6), 2e-7), quantum) == EdgeClass(FDCG_CONCAVE, Flat::quantum));
  CHECK(hinge_class(with_quantum(hinge(1e-6), 1e-8), quantum) == EdgeClass(FDCG_CONCAVE, Flat::no));
  CHECK(hinge_class(with_quantum(hinge(0.017), 1e-8), degree) == EdgeClass(FDCG_CONCAVE, Flat::angle));
  CHECK(hinge_class(with_quantum(hinge(-0.018), 1e-8), degree) == EdgeClass(FDCG_CONVEX, Flat::no));
  CHECK(hinge_class(with_quantum(hinge(1e-6), 2e-7), degree) == EdgeClass(FDCG_CONCAVE, Flat::quantum));
}

TEST_CASE("edge classes: a fold is not flat") {
  const PolygonSoup fold = make_soup("fold", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 2, 0}}, {{0, 1, 2}, {1, 0, 3}});
  CHECK(hinge_class(fold, {}).is_fold());
  const double almost = 3.14159265;
  PolygonSoup knife = hinge(almost);
  knife.absolute_quantum = 1e-3;
  CHECK(hinge_class(knife, {}).flat() == Flat::no);
}
