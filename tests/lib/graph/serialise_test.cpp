// SPDX-License-Identifier: Apache-2.0
#include "graph/serialise.hpp"

#include <cmath>
#include <cstring>

#include "catch.hpp"
#include "compiled.hpp"
#include "graph/fan_tree.hpp"
#include "meshes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

std::vector<fdcg_section> table_of(const std::vector<std::byte>& bytes) {
  fdcg_header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  std::vector<fdcg_section> table(header.section_count);
  std::memcpy(table.data(), bytes.data() + sizeof header, table.size() * sizeof(fdcg_section));
  return table;
}

// Of the corner at a point; zero where there is none.
Vec3 normal_at(const PolygonSoup& soup, const Vec3& point, Precision precision = Precision::f64) {
  CompileOptions options;
  options.merge = false;
  options.precision = precision;
  const WalkedGraph graph = compile_sound(soup, options);
  for (const WalkedCorner& c : graph.corners) {
    if (c.point[0] == point.x && c.point[1] == point.y && c.point[2] == point.z)
      return Vec3{c.normal[0], c.normal[1], c.normal[2]};
  }
  return Vec3{};
}

}  // namespace

TEST_CASE("sections are aligned, ascending, adjacent, padded with zeros and sealed") {
  for (const PolygonSoup& soup : {cube(), cone(100), star_sphere(2, 0.2, 1)}) {
    const std::vector<std::byte> bytes = compile_whole(soup).bytes;
    fdcg_header header;
    std::memcpy(&header, bytes.data(), sizeof header);
    CHECK(header.file_bytes == bytes.size());
    CHECK(std::memcmp(header.magic, FDCG_MAGIC, 8) == 0);
    for (const std::uint8_t byte : header.reserved)
      CHECK(byte == 0);
    CHECK(header.header_checksum == fdcg_checksum(&header, offsetof(fdcg_header, header_checksum)));
    const std::vector<fdcg_section> table = table_of(bytes);
    std::uint64_t at = (sizeof header + table.size() * sizeof(fdcg_section) + 63) / 64 * 64;
    CHECK(header.table_checksum == fdcg_checksum(bytes.data() + sizeof header, at - sizeof header));
    std::uint32_t last_id = 0;
    for (const fdcg_section& section : table) {
      CHECK(section.id > last_id);
      last_id = section.id;
      CHECK(section.offset == at);
      CHECK(section.reserved == 0);
      const std::uint64_t used = section.record_bytes * section.record_count, padded = (used + 63) / 64 * 64;
      for (std::uint64_t i = used; i < padded; ++i)
        CHECK(bytes[section.offset + i] == std::byte{0});
      CHECK(section.checksum == fdcg_checksum(bytes.data() + section.offset, padded));
      at += padded;
    }
    CHECK(at == bytes.size());
  }
}

TEST_CASE("a float file equals the double file to float precision") {
  const PolygonSoup soup = rounded_to_float(star_sphere(3, 0.3, 1));
  CompileOptions options;
  const WalkedGraph wide = compile_sound(soup, options);
  options.precision = Precision::f32;
  const WalkedGraph narrow = compile_sound(soup, options);
  REQUIRE(wide.nodes.size() == narrow.nodes.size());
  CHECK(wide.sides == narrow.sides);
  CHECK(wide.fans == narrow.fans);
  CHECK(wide.source_map == narrow.source_map);
  for (std::size_t n = 0; n < wide.nodes.size(); ++n) {
    for (int k = 0; k < 3; ++k)
      CHECK(std::fabs(wide.nodes[n].plane.normal[k] - narrow.nodes[n].plane.normal[k]) <= 0x1p-24);
    CHECK(std::fabs(wide.nodes[n].plane.offset - narrow.nodes[n].plane.offset) <= 4 * 0x1p-24);
  }
  for (std::size_t c = 0; c < wide.corners.size(); ++c) {
    for (int k = 0; k < 3; ++k)
      CHECK(wide.corners[c].point[k] == narrow.corners[c].point[k]);
  }
}

TEST_CASE("corner normals weigh faces by angle and do not depend on the triangulation") {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Vec3 n = normal_at(triangulated(cube(), seed), {0.5, 0.5, 0.5});
    for (const double component : {n.x, n.y, n.z})
      CHECK(component == Approx(1 / std::sqrt(3.0)).margin(1e-4));
  }
}

// Between the sides of a long funnel the weights are small angles, and their sum points along it.
TEST_CASE("the corner normal of a long funnel points out of it") {
  PolygonSoup funnel = triangulated(cone_pit(6));
  for (Vec3& p : funnel.points)
    p.z *= 1024;
  CHECK(normal_at(funnel, {0, 0, 0}, Precision::f32).z > 0.999);
}

TEST_CASE("corners of many faces have a fan tree") {
  for (const int sides : {33, 500, 10000}) {
    const std::vector<std::byte> bytes = compile_whole(cone(sides)).bytes;
    const WalkedGraph graph = read_graph(bytes);
    std::uint32_t busy = 0, boxes = 0;
    for (const WalkedCorner& c : graph.corners) {
      CHECK(c.is_busy == (c.fan_count > FDCG_BUSY_FAN));
      busy += c.is_busy;
      boxes += fan_box_count(c.fan_count);
    }
    CHECK(busy >= 1);
    CHECK(graph.header.fan_box_count == boxes);
  }
}

TEST_CASE("stored and derived planes have the same bits") {
  const PolygonSoup tiny = scaled(star_sphere(2, 0.3, 5), 1e-8);
  for (const auto precision : {Precision::f64, Precision::f32}) {
    for (const PolygonSoup& soup : {star_sphere(3, 0.3, 1), transformed(grid_box(5, 4, 3, {1, 2, 3}), random_rotation(1)),
                                    cone(40), plane_grid(3, 2), tiny}) {
      CompileOptions options;
      options.precision = precision;
      const std::vector<std::byte> stored = compile_whole(soup, options).bytes;
      options.store_planes = false;
      const std::vector<std::byte> derived = compile_whole(soup, options).bytes;
      CHECK(derived.size() < stored.size());
      fdcg_graph a, b;
      REQUIRE(fdcg_open_memory(stored.data(), stored.size(), FDCG_VERIFY_FULL, &a, nullptr) == FDCG_OK);
      REQUIRE(fdcg_open_memory(derived.data(), derived.size(), FDCG_VERIFY_FULL, &b, nullptr) == FDCG_OK);
      REQUIRE(a.edges != nullptr);
      REQUIRE(b.edges == nullptr);
      std::size_t different = 0;
      for (std::uint32_t n = 0; n < a.header->node_count; ++n) {
        for (std::uint32_t k = 0; k < fdcg_get_node(&a, n).side_count; ++k) {
          const fdcg_side_info p = fdcg_get_side(&a, n, k), q = fdcg_get_side(&b, n, k);
          different += std::memcmp(&p, &q, sizeof p) != 0;
        }
      }
      for (std::uint32_t c = 0; c < a.header->connection_count; ++c) {
        const fdcg_connection_info p = fdcg_get_connection(&a, c), q = fdcg_get_connection(&b, c);
        different += std::memcmp(&p, &q, sizeof p) != 0;
      }
      CHECK(different == 0);
    }
  }
}
