// SPDX-License-Identifier: Apache-2.0
// OpenMesh as a second opinion: the same files give the same faces, and the same coordinates to float precision.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <random>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {

using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;

// Writes a grid of random heights, with some of its quads cut in two, by OpenMesh; reads it by both.
void compare_written(const std::string& file, OpenMesh::IO::Options options) {
  Mesh mesh;
  std::mt19937 random(4);
  const int n = 40;
  std::vector<Mesh::VertexHandle> at;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      at.push_back(
          mesh.add_vertex({static_cast<float>(i) * 0.1F, static_cast<float>(j) * 0.3F, static_cast<float>(random()) * 1e-10F}));
    }
  }
  const bool is_stl = file.ends_with(".stl");
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto a = at[i * (n + 1) + j], b = at[(i + 1) * (n + 1) + j], c = at[(i + 1) * (n + 1) + j + 1],
                 d = at[i * (n + 1) + j + 1];
      if (is_stl || random() % 2 == 0) {
        mesh.add_face(a, b, c);
        mesh.add_face(a, c, d);
      } else {
        mesh.add_face(a, b, c, d);
      }
    }
  }
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("fdcg-openmesh-" + std::to_string(std::random_device{}()) + file);
  REQUIRE(OpenMesh::IO::write_mesh(mesh, path.string(), options, 9));
  const Result<PolygonSoup> soup = import_mesh(path);
  std::filesystem::remove(path);
  REQUIRE(soup);
  check_invariants(*soup);
  REQUIRE(soup->face_count() == mesh.n_faces());
  std::size_t f = 0;
  double largest_error = 0;
  for (const auto face : mesh.faces()) {
    std::uint32_t corner = soup->face_first[f++];
    for (const auto vertex : mesh.fv_range(face)) {
      const Vec3& p = soup->points[soup->corners[corner++]];
      const auto& q = mesh.point(vertex);
      largest_error = std::max({largest_error, std::fabs(p.x - q[0]), std::fabs(p.y - q[1]), std::fabs(p.z - q[2])});
    }
    REQUIRE(corner == soup->face_first[f]);
  }
  CHECK(largest_error < 1e-7 * 12);
}

struct Totals {
  std::size_t faces = 0, points = 0, corners = 0;
  double sum = 0;  // of the absolute coordinates of all faces' corners
};

// A corner that repeats the one before it in its face does not count: OpenMesh drops it.

Totals totals_of(const PolygonSoup& soup) {
  Totals totals{soup.face_count(), soup.points.size()};
  for (std::size_t f = 0; f < totals.faces; ++f) {
    const std::uint32_t end = soup.face_first[f + 1];
    if (soup.face_first[f] == end) continue;
    for (std::uint32_t i = soup.face_first[f], before = soup.corners[end - 1]; i < end; before = soup.corners[i++]) {
      if (soup.corners[i] == before) continue;
      const Vec3& p = soup.points[soup.corners[i]];
      totals.sum += std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);
      ++totals.corners;
    }
  }
  return totals;
}

}  // namespace

TEST_CASE("what OpenMesh writes is read back with the same faces and coordinates") {
  using Options = OpenMesh::IO::Options;
  compare_written(".off", Options::Default);
  compare_written(".obj", Options::Default);
  compare_written(".ply", Options::Default);
  compare_written(".ply", Options::Binary);
  compare_written(".ply", Options(Options::Binary | Options::MSB));
  compare_written(".stl", Options::Default);
  compare_written(".stl", Options::Binary);
}

TEST_CASE("OpenMesh reads no more faces from real meshes, and the same ones where it keeps all") {
  const auto meshes = real_meshes();
  std::size_t same = 0;
  for (const auto& path : meshes) {
    INFO(path);
    const Result<PolygonSoup> soup = import_mesh(path);
    if (!soup) {  // a file of CGAL 6 has a face more than its header says: OpenMesh leaves it out without a word
      CHECK(soup.error().message.find("but data follows them") != std::string::npos);
      continue;
    }
    Mesh mesh;
    omerr().disable();
    if (!OpenMesh::IO::read_mesh(mesh, path.string())) continue;
    const Totals ours = totals_of(*soup);
    // Vertices that OpenMesh doubles at non-manifold places do not count; faces do, and it drops or repeats none in clean
    // meshes.
    if (mesh.n_faces() != ours.faces) continue;
    double sum = 0;
    std::size_t corners = 0;
    for (const auto face : mesh.faces()) {
      for (const auto vertex : mesh.fv_range(face)) {
        const auto& p = mesh.point(vertex);
        sum += std::fabs(double{p[0]}) + std::fabs(double{p[1]}) + std::fabs(double{p[2]});
        ++corners;
      }
    }
    CHECK(corners == ours.corners);
    if (std::isfinite(ours.sum)) CHECK(sum == Approx(ours.sum).epsilon(1e-6));
    ++same;
  }
  WARN(meshes.size() << " real meshes found, " << same << " of them with the same faces in OpenMesh");
  if (!meshes.empty()) CHECK(same * 2 > meshes.size());
}
