// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "../../support/gltf_scene.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;

namespace {

using Faces = std::vector<std::vector<std::uint32_t>>;
using Points = std::vector<Vec3>;

const Points kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

std::uint64_t ignored(const PolygonSoup& soup, const std::string& what) {
  for (const Ignored& entry : soup.ignored) {
    if (entry.what == what) return entry.count;
  }
  return 0;
}

// The square's points as a scene of the one node shows them.
Points shown_by(const Json& node) {
  GltfScene scene = square_mesh();
  Json with_mesh = node;
  with_mesh["mesh"] = 0;
  scene.node(with_mesh);
  return import_text(scene.text()).points;
}

double distance(const Points& a, const Points& b) {
  double most = a.size() == b.size() ? 0 : 1e9;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
    most = std::max({most, std::fabs(a[i].x - b[i].x), std::fabs(a[i].y - b[i].y), std::fabs(a[i].z - b[i].z)});
  return most;
}

}  // namespace

TEST_CASE("identity transforms keep every bit, also in a hierarchy") {
  GltfScene scene = square_mesh();
  const float tiny = std::numeric_limits<float>::denorm_min(), huge = std::numeric_limits<float>::max();
  scene.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      scene.positions({-0.f, tiny, huge, 0.1f, std::numeric_limits<float>::infinity(), 0, 1, 1, 1, 0, 1, 1});
  scene.node({{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}, false);
  scene.node({{"children", {0}}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, 1, 1}}, {"translation", {0, 0, 0}}});
  const PolygonSoup soup = import_text(scene.text());
  CHECK(std::signbit(soup.points[0].x));
  CHECK(soup.points[0].y == static_cast<double>(tiny));
  CHECK(soup.points[0].z == static_cast<double>(huge));
  CHECK(soup.points[1].x == static_cast<double>(0.1f));
  CHECK(std::isinf(soup.points[1].y));
  CHECK(soup.points[1].z == 0);
  CHECK(soup.relative_quantum == 0x1p-24);
  CHECK(soup.absolute_quantum == 0);
}

TEST_CASE("translation, rotation and scale come in that order; a matrix is read column by column") {
  CHECK(shown_by({{"translation", {1, 2, 3}}}) == Points{{1, 2, 3}, {2, 2, 3}, {2, 3, 3}, {1, 3, 3}});
  CHECK(shown_by({{"scale", {2, 3, 4}}}) == Points{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}});
  const double half = std::sqrt(0.5);  // a quarter turn about z
  CHECK(distance(shown_by({{"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}, {"scale", {2, 1, 1}}}),
                 {{10, 0, 0}, {10, 2, 0}, {9, 2, 0}, {9, 0, 0}}) < 1e-15);
  // Few digits of the quaternion turn a little less, and stretch nothing.
  const Points rounded = shown_by({{"rotation", {0, 0, 0.707, 0.707}}});
  CHECK(distance(rounded, {{0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}}) < 1e-15);
  CHECK(shown_by({{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}) ==
        Points{{5, 6, 7}, {5, 7, 7}, {4, 7, 7}, {4, 6, 7}});
}

TEST_CASE("transforms apply from the mesh outwards, in double") {
  GltfScene scene = square_mesh();
  scene.node({{"mesh", 0}, {"translation", {1, 0, 0}}}, false);
  scene.node({{"children", {0}}, {"scale", {10, 10, 10}}}, false);
  scene.node({{"children", {1}}, {"translation", {0.1, 0, 0}}});
  CHECK(import_text(scene.text()).points == Points{{10.1, 0, 0}, {20.1, 0, 0}, {20.1, 10, 0}, {10.1, 10, 0}});
}

TEST_CASE("a mirroring node flips its faces, so that they stay outward") {
  GltfScene scene = square_mesh();
  scene.node({{"mesh", 0}, {"scale", {-1, 1, 1}}}, false);
  scene.node({{"children", {0}}});
  CHECK(faces_of(import_text(scene.text())) == Faces{{0, 2, 1}, {0, 3, 2}});
  scene.json["nodes"][1]["scale"] = {1, 1, -1};
  CHECK(faces_of(import_text(scene.text())) == Faces{{0, 1, 2}, {0, 2, 3}});
  scene.json["nodes"][1]["scale"] = {1, 1, 1};
  for (const auto& [mode, faces] : {std::pair(5, Faces{{0, 2, 1}, {1, 2, 3}}), std::pair(6, Faces{{0, 2, 1}, {0, 3, 2}})}) {
    scene.json["meshes"][0]["primitives"][0].erase("indices");
    scene.json["meshes"][0]["primitives"][0]["mode"] = mode;
    CHECK(faces_of(import_text(scene.text())) == faces);
  }
}

TEST_CASE("integer positions scaled and mirrored by a node give the unit cube") {
  const Result<PolygonSoup> soup = import_mesh(testdata() / "meshes" / "good" / "mirrored_bytes.gltf");
  REQUIRE(soup);
  double volume = 0;
  for (std::size_t f = 0; f < soup->face_count(); ++f) {
    const auto corner = [&](std::size_t k) { return soup->points[soup->corners[3 * f + k]]; };
    const Vec3 a = corner(0), b = corner(1), c = corner(2);
    volume += (a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x)) / 6;
  }
  CHECK(volume == Approx(1));
}

TEST_CASE("a mesh is instanced once per node, with separate points where transformed") {
  GltfScene scene = square_mesh();
  scene.node({{"mesh", 0}, {"name", "first"}});
  scene.node({{"mesh", 0}, {"name", "second"}, {"translation", {5, 0, 0}}});
  scene.node({{"mesh", 0}, {"name", "third"}});
  const PolygonSoup soup = import_text(scene.text());
  CHECK(soup.points.size() == 8);  // first and third lie on the same ones
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {0, 1, 2}, {0, 2, 3}});
  REQUIRE(soup.parts.size() == 3);
  CHECK(soup.parts[1].name == "second/meshes[0]/primitive 0");
  CHECK(soup.parts[1].first_face == 2);
  CHECK(soup.parts[1].first_point == 4);
  CHECK(soup.parts[2].first_point == 0);
}

TEST_CASE("the default scene is read, else the first, else every root; others are counted") {
  GltfScene scene = square_mesh();
  scene.node({{"mesh", 0}, {"translation", {1, 0, 0}}});
  scene.node({{"mesh", 0}, {"translation", {2, 0, 0}}}, false);
  scene.mesh(scene.json["meshes"][0]["primitives"][0]);
  scene.json["scenes"].push_back({{"nodes", {1}}});
  const auto first_x = [&] { return import_text(scene.text()).points[0].x; };
  CHECK(first_x() == 1);
  CHECK(ignored(import_text(scene.text()), "nodes with a mesh outside the scene") == 1);
  CHECK(ignored(import_text(scene.text()), "meshes of no node") == 1);
  scene.json["scene"] = 1;
  CHECK(first_x() == 2);
  scene.json.erase("scene");
  CHECK(first_x() == 1);
  scene.json.erase("scenes");
  const PolygonSoup all = import_text(scene.text());
  CHECK(all.points.size() == 8);
  CHECK(ignored(all, "nodes with a mesh outside the scene") == 0);
}

TEST_CASE("skins and morph targets are read in rest pose, and counted") {
  GltfScene scene = square();
  scene.json["nodes"][0]["skin"] = 0;
  scene.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
  const PolygonSoup soup = import_text(scene.text());
  CHECK(soup.points == kSquare);
  CHECK(ignored(soup, "skins (shown at rest)") == 1);
  CHECK(ignored(soup, "primitives with morph targets (shown at rest)") == 1);
}

TEST_CASE("a chain of a hundred thousand nodes is read") {
  GltfScene scene = square_mesh();
  constexpr int kDepth = 100'000;
  for (int i = 0; i < kDepth; ++i)
    scene.node({{"children", {i + 1}}, {"translation", {1, 0, 0}}}, i == 0);
  scene.node({{"mesh", 0}}, false);
  CHECK(import_text(scene.text()).points[0] == Vec3{kDepth, 0, 0});
}

TEST_CASE("flat faces stay flat within the quantum under any transform") {
  // Points of a plane through the origin, rounded to floats; then turned, stretched and moved far away.
  GltfScene scene;
  std::vector<float> xyz;
  for (int i = 0; i < 64; ++i) {
    const double u = i % 8 - 3.3, v = i / 8 - 2.7;
    for (const double c : {0.31 * u + 0.2 * v, 0.7 * u - 0.41 * v, 0.123 * u + 0.77 * v})
      xyz.push_back(static_cast<float>(c));
  }
  scene.mesh({{"attributes", {{"POSITION", scene.positions(xyz)}}}});
  scene.node({{"mesh", 0}, {"rotation", {0.5, 0.5, -0.5, 0.5}}, {"scale", {3, 2, 0.1}}, {"translation", {1000, -2000, 500}}});
  const PolygonSoup soup = import_text(scene.text());
  CHECK(soup.relative_quantum == 0x1p-53);
  // No coordinate exceeds 16 after the stretch: what rounding to floats did stays below 2^-24 of the sum of its terms.
  CHECK(soup.absolute_quantum > 0);
  CHECK(soup.absolute_quantum < 64 * 0x1p-24);
  const Vec3 o = soup.points[0], a = soup.points[7], b = soup.points[56];
  const Vec3 p = {a.x - o.x, a.y - o.y, a.z - o.z}, q = {b.x - o.x, b.y - o.y, b.z - o.z};
  const Vec3 n = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
  const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  double off = 0;
  for (const Vec3& c : soup.points)
    off = std::max(off, std::fabs(n.x * (c.x - o.x) + n.y * (c.y - o.y) + n.z * (c.z - o.z)) / length);
  CHECK(off <= 4 * std::sqrt(3) * soup.absolute_quantum);
  CHECK(off > 0);
}
