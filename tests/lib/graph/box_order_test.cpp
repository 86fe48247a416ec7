// SPDX-License-Identifier: Apache-2.0
#include "graph/box_order.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/vec3.hpp"
#include "catch.hpp"
#include "meshes.hpp"
#include "topology/weld.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

std::vector<std::uint32_t> all_faces(const Mesh& mesh) {
  std::vector<std::uint32_t> faces(mesh.face_count());
  std::iota(faces.begin(), faces.end(), 0u);
  return faces;
}

std::vector<std::uint32_t> ordered(const Mesh& mesh, std::vector<std::uint32_t> faces, unsigned jobs = 1) {
  order_by_boxes(mesh, faces, jobs);
  return faces;
}

// The mean over whole runs of `count` faces of the largest side of the box that holds them.
double mean_size_of_runs(const Mesh& mesh, const std::vector<std::uint32_t>& faces, std::size_t count) {
  double sum = 0;
  for (std::size_t first = 0; first + count <= faces.size(); first += count) {
    Vec3 low = mesh.points[+mesh.corners[mesh.face_first[faces[first]]]], high = low;
    for (std::size_t i = first; i < first + count; ++i) {
      for (std::uint32_t h = mesh.face_first[faces[i]]; h < mesh.face_first[faces[i] + 1]; ++h) {
        const Vec3& p = mesh.points[+mesh.corners[h]];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    }
    sum += largest_component(high - low);
  }
  return sum / static_cast<double>(faces.size() / count);
}

}  // namespace

TEST_CASE("boxes' order: each face once, whatever the order before and the threads") {
  for (const PolygonSoup& soup : {star_sphere(7, 0.3, 1), plane_grid(9, 7), thin_plate(1e-9, 5), scaled(torus(60, 40), 1e30),
                                  moved(needle_strip(100, 0.3, 2), {1e6, -1e6, 0})}) {
    const Mesh mesh = weld_points(soup, {}, Precision::f64);
    const std::vector<std::uint32_t> faces = all_faces(mesh), order = ordered(mesh, faces);
    std::vector<std::uint32_t> sorted = order, shuffled = faces;
    std::sort(sorted.begin(), sorted.end());
    CHECK(sorted == faces);
    std::mt19937 random(7);
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    CHECK(ordered(mesh, shuffled) == order);
    for (const unsigned jobs : {2u, 5u, 64u})
      CHECK(ordered(mesh, faces, jobs) == order);
  }
}

TEST_CASE("boxes' order: what a box holds is about as compact as it can be") {
  // Of a square grid of 64 by 64 cells, two triangles each, a run of n faces covers n / 2 cells: a square of sqrt(n / 2), or
  // twice that side long where its number is no square.
  constexpr int kCells = 64;
  const Mesh mesh = weld_points(plane_grid(kCells, kCells), {}, Precision::f64);
  REQUIRE(mesh.face_count() == 2 * kCells * kCells);
  const std::vector<std::uint32_t> order = ordered(mesh, all_faces(mesh));
  const double cell = mean_size_of_runs(mesh, all_faces(mesh), 1);
  for (const std::size_t count : {4u, 32u, 256u, 2048u}) {
    INFO(count);
    CHECK(mean_size_of_runs(mesh, order, count) <= 1.5 * std::sqrt(static_cast<double>(count) / 2) * cell);
  }
}
