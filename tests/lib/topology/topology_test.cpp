// SPDX-License-Identifier: Apache-2.0
#include "topology/topology.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "catch.hpp"
#include "soups.hpp"
#include "topology/weld.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::make_soup;

namespace {

Mesh weld(const PolygonSoup& soup) {
  return weld_points(soup, {}, Precision::f64);
}

// The pairing by a tree of pairs.
std::vector<HalfedgeId> pair_by_map(const Mesh& mesh) {
  struct Use {
    std::uint32_t slot, from;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Use>> edges;
  std::vector<HalfedgeId> twin(mesh.corners.size(), Topology::kSkipped);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<std::uint32_t> loop;
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h)
      loop.push_back(+mesh.corners[h]);
    std::vector<std::uint32_t> distinct = loop;
    std::sort(distinct.begin(), distinct.end());
    const bool repeats = std::adjacent_find(distinct.begin(), distinct.end()) != distinct.end();
    if (loop.size() < 3 || repeats || distinct.back() == kNone) continue;
    for (std::uint32_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t u = loop[i], v = loop[(i + 1) % loop.size()];
      edges[std::minmax(u, v)].push_back({mesh.face_first[f] + i, u});
    }
  }
  for (const auto& [edge, uses] : edges) {
    for (std::size_t i = 0; i < uses.size(); ++i) {
      HalfedgeId& entry = twin[uses[i].slot];
      if (uses.size() == 1) entry = Topology::kBoundary;
      if (uses.size() > 2) entry = Topology::kNonManifold;
      if (uses.size() == 2) entry = uses[0].from == uses[1].from ? Topology::kSameWay : HalfedgeId{uses[1 - i].slot};
    }
  }
  return twin;
}

}  // namespace

TEST_CASE("on a closed mesh each half-edge has a twin that runs the other way, and twins are mutual") {
  for (const PolygonSoup& soup : {cube(), bumpy_sphere(20, 30)}) {
    const Mesh mesh = weld(soup);
    const Topology topology = pair_halfedges(mesh);
    for (std::uint32_t h = 0; h < mesh.corners.size(); ++h) {
      const HalfedgeId twin = topology.twin[h];
      REQUIRE(+twin < mesh.corners.size());
      CHECK(topology.twin[+twin] == HalfedgeId{h});
      CHECK(mesh.corners[+next(mesh, topology.face(twin), twin)] == mesh.corners[h]);
      CHECK(topology.face(twin) != topology.face(HalfedgeId{h}));
    }
  }
}

TEST_CASE("face_of is left empty only where every face is a triangle") {
  CHECK(pair_halfedges(weld(bumpy_sphere(4, 5))).face_of.empty());
  const Topology quads = pair_halfedges(weld(cube()));
  REQUIRE(quads.face_of.size() == 24);
  for (std::uint32_t h = 0; h < 24; ++h)
    CHECK(quads.face(HalfedgeId{h}) == FaceId{h / 4});
  // As many corners as triangles would have, but they are a quad, a pair and a triangle.
  const PolygonSoup mixed = make_soup({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}, {0, 1}, {0, 1, 2}});
  CHECK(pair_halfedges(weld(mixed)).face(HalfedgeId{3}) == FaceId{0});
}

TEST_CASE("boundary, same-way and non-manifold edges are distinguished, and skipped faces are ignored") {
  const PolygonSoup soup = make_soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {5, 5, 5}},
                                     {{0, 1, 2}, {0, 1, 3}, {0, 1, 0}, {0, 1, 9}, {0, 1}});
  Topology two = pair_halfedges(weld(soup));
  CHECK(two.twin[0] == Topology::kSameWay);
  CHECK(two.twin[3] == Topology::kSameWay);
  CHECK(two.twin[1] == Topology::kBoundary);
  for (std::uint32_t h = 6; h < two.twin.size(); ++h)
    CHECK(two.twin[h] == Topology::kSkipped);

  const PolygonSoup fan = make_soup(soup.points, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const Topology three = pair_halfedges(weld(fan));
  for (const std::uint32_t h : {0U, 3U, 6U})
    CHECK(three.twin[h] == Topology::kNonManifold);

  std::vector<FaceState> states = face_states(weld(fan));
  states[2] = FaceState::repeated_corner;  // left out by the caller: the other two are a pair again
  CHECK(pair_halfedges(weld(fan), states).twin[0] == HalfedgeId{3});
}

TEST_CASE("a polygon with a repeated corner is recognised at any distance in the loop") {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 2}};
  const auto states = face_states(
      weld(make_soup(points, {{0, 1, 2, 3}, {0, 1, 2, 0}, {0, 1, 2, 1, 3}, {0, 1, 2, 3, 4}, {}, {3}, {7, 7, 7, 7}})));
  using enum FaceState;
  CHECK(states == std::vector<FaceState>{sound, repeated_corner, repeated_corner, sound, repeated_corner, repeated_corner,
                                         invalid_corner});
}

TEST_CASE("the pairing agrees with a search tree on random polygons over few and many vertices") {
  std::mt19937 rng(99);
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t vertices = 3 + rng() % (round % 3 == 0 ? 5 : 60);
    std::vector<Vec3> points(vertices);
    for (std::uint32_t v = 0; v < vertices; ++v)
      points[v] = {static_cast<double>(v), 1, -1};
    fdcg::test::Faces faces(rng() % 80);
    for (auto& face : faces) {
      face.resize(round % 2 == 0 ? 3 : rng() % 7);
      for (auto& corner : face)
        corner = rng() % (vertices + (rng() % 40 == 0));
    }
    const Mesh mesh = weld(make_soup(points, faces));
    CHECK(pair_halfedges(mesh).twin == pair_by_map(mesh));
  }
}

TEST_CASE("a vertex of a hundred thousand faces is paired like any other") {
  constexpr std::uint32_t kFaces = 100000;
  std::vector<Vec3> points{{0, 0, 1}};
  fdcg::test::Faces faces;
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    points.push_back({std::cos(i * 6.283185307179586 / kFaces), std::sin(i * 6.283185307179586 / kFaces), 0});
    faces.push_back({0, 1 + i, 1 + (i + 1) % kFaces});
  }
  const Mesh mesh = weld(make_soup(points, faces));
  const Topology topology = pair_halfedges(mesh);
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    CHECK(topology.twin[3 * i + 1] == Topology::kBoundary);
    CHECK(topology.twin[3 * i + 2] == HalfedgeId{3 * ((i + 1) % kFaces)});
  }
}

TEST_CASE("a mesh of invalid faces only has no edges to pair") {
  const Mesh mesh = weld(make_soup({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 7}, {0, 0, 1}, {}}));
  CHECK(pair_halfedges(mesh).twin == std::vector<HalfedgeId>(6, Topology::kSkipped));
}

TEST_CASE("weld, states and pairing are the same on one thread and on several") {
  std::mt19937 rng(7);
  PolygonSoup soup;
  soup.face_first.push_back(0);
  for (int i = 0; i < 150'000; ++i)
    soup.points.push_back({static_cast<double>(rng() % 40), static_cast<double>(rng() % 40), i % 1000 == 0 ? NAN : rng() % 40});
  for (int f = 0; f < 60'000; ++f) {
    for (unsigned k = 0; k < 3 + rng() % 3; ++k)
      soup.corners.push_back(rng() % 5000 == 0 ? PolygonSoup::kInvalidVertex : static_cast<std::uint32_t>(rng() % 150'000));
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  const Mesh mesh = weld_points(soup, {}, Precision::f64, 1);
  const std::vector<FaceState> states = face_states(mesh);
  const Topology topology = pair_halfedges(mesh, states);
  for (const unsigned jobs : {2u, 3u, 9u}) {
    const Mesh other = weld_points(soup, {}, Precision::f64, jobs);
    CHECK((other.source_point == mesh.source_point));
    CHECK((other.corners == mesh.corners));
    CHECK(other.joined_vertices == mesh.joined_vertices);
    CHECK((face_states(mesh, jobs) == states));
    CHECK((pair_halfedges(mesh, states, jobs).twin == topology.twin));
  }
}
