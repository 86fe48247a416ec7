// SPDX-License-Identifier: Apache-2.0
// The compiler's C API: the bytes of compile(), findings as values, memory of the caller's.
#include "fdcg/bake.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "meshes.hpp"

using namespace fdcg::test;
namespace bake = fdcg::bake;
using Catch::Matchers::ContainsSubstring;

namespace {

struct Arrays {
  std::vector<double> points;
  std::vector<std::uint32_t> corners, sides;

  explicit Arrays(const bake::PolygonSoup& soup) : corners(soup.corners) {
    for (const bake::Vec3& p : soup.points)
      points.insert(points.end(), {p.x, p.y, p.z});
    for (std::size_t f = 0; f < soup.face_count(); ++f)
      sides.push_back(soup.face_first[f + 1] - soup.face_first[f]);
  }
  fdcg_status bake(const fdcg_bake_options& options, fdcg_finding* findings, std::uint32_t capacity, fdcg_baked* baked,
                   fdcg_error* error) const {
    return fdcg_bake(points.data(), points.size() / 3, corners.data(), sides.data(), sides.size(), &options, findings, capacity,
                     baked, error);
  }
};

struct Heap {
  std::uint64_t asked = 0;
  void* given = nullptr;
  bool is_empty = false;
};

void* allocate(void* context, std::uint64_t bytes) {
  auto* const heap = static_cast<Heap*>(context);
  heap->asked = bytes;
  heap->given = heap->is_empty ? nullptr : std::aligned_alloc(64, (bytes + 63) / 64 * 64);
  return heap->given;
}

}  // namespace

TEST_CASE("bake_c: a mesh becomes the nodes that compile() makes of it") {
  for (const bake::PolygonSoup& soup : {cube(), ico_sphere(3), l_prism(), cone(50)}) {
    const Arrays mesh(soup);
    for (const std::uint32_t real_bytes : {8u, 4u}) {
      fdcg_bake_options options = fdcg_make_bake_options();
      options.real_bytes = real_bytes;
      options.metres_per_unit = 0.01;
      options.density_kg_per_m3 = 1000;
      fdcg_baked baked = fdcg_make_baked();
      fdcg_error error = {};
      INFO(soup.name << " " << error.message);
      REQUIRE(mesh.bake(options, nullptr, 0, &baked, &error) == FDCG_OK);
      bake::PolygonSoup same = soup;
      same.relative_quantum = 0x1p-53;
      bake::CompileOptions how;
      how.precision = real_bytes == 8 ? bake::Precision::f64 : bake::Precision::f32;
      how.metres_per_unit = 0.01;
      how.density_kg_per_m3 = 1000;
      const auto compiled = bake::compile(same, how);
      REQUIRE(compiled);
      const auto* const ours = static_cast<const std::byte*>(baked.bytes);
      fdcg_header mine, theirs;
      std::memcpy(&mine, ours, sizeof mine);
      std::memcpy(&theirs, compiled->bytes.data(), sizeof theirs);
      CHECK(mine.file_bytes == baked.byte_count);
      CHECK(mine.node_count == theirs.node_count);
      CHECK(mine.connection_count == theirs.connection_count);
      CHECK(std::memcmp(ours + 1024, compiled->bytes.data() + 1024, 512) == 0);
      fdcg_baked_free(&baked);
      CHECK(baked.bytes == nullptr);
    }
  }
}

TEST_CASE("bake_c: of a quantum a thousandth of the largest coordinate counts") {
  const bake::PolygonSoup soup = ico_sphere(2);
  double largest = 0;
  for (const bake::Vec3& p : soup.points)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const Arrays mesh(soup);
  for (const double quantum : {1e-4 * largest, 0.5 * largest}) {
    fdcg_bake_options options = fdcg_make_bake_options();
    options.quantum = quantum;
    fdcg_baked baked = fdcg_make_baked();
    fdcg_error error = {};
    REQUIRE(mesh.bake(options, nullptr, 0, &baked, &error) == FDCG_OK);
    fdcg_header header;
    std::memcpy(&header, baked.bytes, sizeof header);
    CHECK(header.quantum == std::min(quantum, 1e-3 * largest));
    CHECK(header.node_count > soup.face_count() / 2);  // the sphere is still one
    fdcg_baked_free(&baked);
  }
}

TEST_CASE("bake_c: findings are values, with the place of the first") {
  bake::PolygonSoup soup = cube();
  soup.corners.insert(soup.corners.end(), {0, 1, 99});
  soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  const Arrays mesh(soup);
  fdcg_finding findings[8] = {};
  fdcg_baked baked = fdcg_make_baked();
  fdcg_error error = {};
  CHECK(mesh.bake(fdcg_make_bake_options(), findings, 8, &baked, &error) == FDCG_E_MESH);
  CHECK(baked.bytes == nullptr);
  REQUIRE(baked.finding_count >= 1);
  CHECK(findings[0].rule == std::string("index-out-of-range"));
  CHECK(findings[0].severity == FDCG_ERROR);
  CHECK(findings[0].total == 1);
  CHECK(findings[0].first_face == 6);
  CHECK_THAT(findings[0].message, ContainsSubstring("1"));
  CHECK_THAT(error.message, ContainsSubstring("the mesh has errors"));
  CHECK(std::string(fdcg_status_text(FDCG_E_MESH)) == "the mesh has errors");
}

TEST_CASE("bake_c: the bytes go where the caller says, once, and no memory is a value") {
  const Arrays mesh(ico_sphere(2));
  Heap heap;
  fdcg_bake_options options = fdcg_make_bake_options();
  options.allocate = allocate;
  options.context = &heap;
  fdcg_baked baked = fdcg_make_baked();
  fdcg_error error = {};
  REQUIRE(mesh.bake(options, nullptr, 0, &baked, &error) == FDCG_OK);
  CHECK(baked.bytes == heap.given);
  CHECK(baked.byte_count == heap.asked);
  fdcg_graph graph;
  CHECK(fdcg_open_memory(baked.bytes, baked.byte_count, FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  std::free(heap.given);
  heap.is_empty = true;
  CHECK(mesh.bake(options, nullptr, 0, &baked, &error) == FDCG_E_MEMORY);
  CHECK(baked.bytes == nullptr);
}

TEST_CASE("bake_c: what cannot be is refused") {
  const Arrays mesh(cube());
  fdcg_baked baked = fdcg_make_baked();
  fdcg_error error = {};
  fdcg_bake_options options = fdcg_make_bake_options();
  options.real_bytes = 16;
  CHECK(mesh.bake(options, nullptr, 0, &baked, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("options.real_bytes"));
  options = fdcg_make_bake_options();
  options.metres_per_unit = 0;
  CHECK(mesh.bake(options, nullptr, 0, &baked, &error) == FDCG_E_ARGUMENT);
  options = {};
  CHECK(mesh.bake(options, nullptr, 0, &baked, &error) == FDCG_E_ARGUMENT);
  CHECK_THAT(error.message, ContainsSubstring("fdcg_make_bake_options"));
  fdcg_baked zero = {};
  CHECK(mesh.bake(fdcg_make_bake_options(), nullptr, 0, &zero, &error) == FDCG_E_ARGUMENT);
  options = fdcg_make_bake_options();
  CHECK(fdcg_bake(nullptr, 8, mesh.corners.data(), nullptr, 1, &options, nullptr, 0, &baked, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_bake(nullptr, 0, nullptr, nullptr, 0, &options, nullptr, 0, &baked, &error) == FDCG_E_MESH);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Arrays bad(cube());
  bad.points[4] = nan;
  CHECK(bad.bake(options, nullptr, 0, &baked, &error) == FDCG_E_MESH);
}
