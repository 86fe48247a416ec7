// SPDX-License-Identifier: Apache-2.0
#include "topology/orient.hpp"

#include <algorithm>
#include <random>

#include "catch.hpp"
#include "soups.hpp"
#include "topology/weld.hpp"
#include "validate/validate.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::joined;
using fdcg::test::make_soup;
using fdcg::test::reversed;

namespace {

struct Oriented {
  Mesh mesh;
  Topology topology;
  std::vector<std::uint32_t> flipped;
  Report report;
};

Oriented oriented(const PolygonSoup& soup) {
  Oriented out;
  out.mesh = weld_points(soup, {}, Precision::f64);
  const auto states = face_states(out.mesh);
  out.topology = pair_halfedges(out.mesh, states);
  for (const FaceId f : orient(out.mesh, out.topology, states))
    out.flipped.push_back(+f);
  CHECK(out.topology.twin == pair_halfedges(out.mesh).twin);
  out.report = check(soup, out.mesh, out.topology, states, {});
  return out;
}

// The corners of each face, turned so that the smallest comes first: equal for the same winding.
std::vector<std::vector<std::uint32_t>> loops(const PolygonSoup& soup) {
  std::vector<std::vector<std::uint32_t>> result;
  const Mesh mesh = weld_points(soup, {}, Precision::f64);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    auto& loop = result.emplace_back();
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h)
      loop.push_back(+mesh.corners[h]);
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  return result;
}
PolygonSoup as_soup(const Mesh& mesh) {
  PolygonSoup soup;
  soup.points = mesh.points;
  soup.face_first = mesh.face_first;
  for (const VertexId v : mesh.corners)
    soup.corners.push_back(+v);
  return soup;
}

void flip_face(PolygonSoup& soup, std::uint32_t f) {
  std::reverse(soup.corners.begin() + soup.face_first[f], soup.corners.begin() + soup.face_first[f + 1]);
}

}  // namespace

TEST_CASE("a consistent outward mesh is not changed") {
  for (const PolygonSoup& soup : {cube(), bumpy_sphere(12, 16), joined(cube({}, 4), reversed(cube({}, 2)))}) {
    const Oriented result = oriented(soup);
    CHECK(result.flipped.empty());
    CHECK(loops(as_soup(result.mesh)) == loops(soup));
  }
}

TEST_CASE("flipping any subset of the faces of a solid is undone, and the flipped faces are reported") {
  std::mt19937 rng(31);
  const PolygonSoup hollow = joined(joined(cube({}, 4), reversed(cube({}, 2))), cube({9, 0, 0}, 3));
  for (const PolygonSoup& clean : {cube(), bumpy_sphere(8, 9), hollow}) {
    for (int round = 0; round < 60; ++round) {
      PolygonSoup soup = clean;
      std::vector<std::uint32_t> expected;
      for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
        // Not the cavity as a whole: a consistent one that looks outwards is taken for a solid in a solid.
        if (rng() % 10 >= static_cast<unsigned>(round % 10) && !(f == 6 && clean.face_count() == 18)) continue;
        if (f == 7 && clean.face_count() == 18) continue;
        flip_face(soup, f);
        expected.push_back(f);
      }
      const Oriented result = oriented(soup);
      CHECK(result.flipped == expected);
      CHECK(loops(as_soup(result.mesh)) == loops(clean));
      CHECK(result.report.issues.size() == (clean.points.size() < result.mesh.points.size()));
    }
  }
}

TEST_CASE("a closed part inside out is flipped, one that bounds a cavity is not") {
  CHECK(oriented(reversed(cube())).flipped == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5});
  CHECK(oriented(joined(cube({-3, 0, 0}), reversed(cube({3, 0, 0})))).flipped ==
        std::vector<std::uint32_t>{6, 7, 8, 9, 10, 11});
  CHECK(oriented(joined(cube({}, 4), reversed(cube({}, 2)))).flipped.empty());
  CHECK(oriented(joined(cube({}, 4), cube({}, 2))).flipped.empty());
}

TEST_CASE("an open patch keeps the orientation of its majority, of equal halves that of the first face") {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 1, 0}};
  const PolygonSoup strip = make_soup(points, {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}});
  for (std::uint32_t f = 0; f < 3; ++f) {
    PolygonSoup soup = strip;
    flip_face(soup, f);
    CHECK(oriented(soup).flipped == std::vector<std::uint32_t>{f});
  }
  CHECK(oriented(reversed(strip)).flipped.empty());
  const PolygonSoup two = make_soup(points, {{0, 4, 5, 1}, {1, 2, 6, 5}});
  CHECK(oriented(two).flipped == std::vector<std::uint32_t>{1});
}

TEST_CASE("a patch that cannot be oriented is unchanged and reported") {
  std::vector<Vec3> points;
  for (int i = 0; i < 6; ++i)
    points.push_back({i * 1.0, i * i * 1.0, i * i * i * 1.0});
  // Five triangles on a Moebius strip, and a sound tetrahedron with a flipped face beside it.
  PolygonSoup strip = make_soup(points, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}});
  const Oriented alone = oriented(strip);
  CHECK(alone.flipped.empty());
  CHECK(std::any_of(alone.report.issues.begin(), alone.report.issues.end(),
                    [](const Issue& i) { return i.rule == "not-orientable"; }));
  PolygonSoup solid = cube({20, 20, 20});
  flip_face(solid, 2);
  CHECK(oriented(joined(strip, solid)).flipped == std::vector<std::uint32_t>{7});
}

TEST_CASE("faces of more than two at an edge belong to patches of their own") {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {1, 1, 0}};
  const PolygonSoup soup = make_soup(points, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 2, 5}});
  // Face 3 runs along 1-2 as face 0 does: the two are a patch of equal halves, the later one is flipped.
  CHECK(oriented(soup).flipped == std::vector<std::uint32_t>{3});
  CHECK(oriented(PolygonSoup{}).flipped.empty());
}
