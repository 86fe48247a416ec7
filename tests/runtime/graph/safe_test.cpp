// SPDX-License-Identifier: Apache-2.0
// What FDCG_VERIFY_SAFE lets through and FDCG_VERIFY_FULL does not: files that are no surface. A step on one may say anything,
// but nothing undefined, and its numbers are numbers.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

AlignedBytes compiled(const PolygonSoup& soup, Precision precision) {
  CompileOptions options;
  options.precision = precision;
  options.merge = false;
  const auto result = fdcg::bake::compile(soup, options);
  REQUIRE(result);
  return AlignedBytes(result->bytes);
}

const fdcg_section& section_of(AlignedBytes& file, std::uint32_t id) {
  const auto* sections = reinterpret_cast<const fdcg_section*>(file.data() + sizeof(fdcg_header));
  while (sections->id != id)
    ++sections;
  return *sections;
}

// Hands that press on every corner from all around, with a little friction and without.
void press_on_corners(const fdcg_graph& graph) {
  for (std::uint32_t v = 0; v < graph.header->corner_count; ++v) {
    const fdcg_corner_info corner = fdcg_get_corner(&graph, v);
    for (int i = 0; i < 26; ++i) {
      const int code = i < 13 ? i : i + 1;
      const double way[3] = {code / 9 - 1.0, code / 3 % 3 - 1.0, code % 3 - 1.0};
      Contact contact(graph, contact_params(i % 2 == 0 ? 0 : 0.3, i % 2 == 0 ? 0 : 0.2));
      for (const double depth : {-0.5, 0.0, 0.1, 0.6, -0.1, 0.3}) {
        Hip hip;
        for (std::size_t k = 0; k < 3; ++k)
          hip[k] = corner.point[k] + graph.header->origin[k] + depth * way[k];
        contact.step(hip);
        REQUIRE(std::isfinite(norm(contact.force())));
      }
    }
  }
}

// One level after the other, as callers do who verify chunks themselves.
fdcg_status level_by_level(AlignedBytes& file) {
  fdcg_graph graph;
  fdcg_error error;
  fdcg_status status = fdcg_open_trusted(file.data(), file.size(), &graph, &error);
  for (const auto level : {FDCG_VERIFY_SAFE, FDCG_VERIFY_FULL}) {
    fdcg_verification sum = {};
    for (std::uint32_t i = 0; status == FDCG_OK && i < fdcg_verify_chunk_count(&graph); ++i)
      status = fdcg_verify_chunk(&graph, level, i, &sum, &error);
    if (status == FDCG_OK) status = fdcg_verify_sum(&graph, level, &sum, 1, &error);
  }
  return status;
}

}  // namespace

TEST_CASE("opening, which verifies both levels of a chunk at once, accepts what one level after the other does") {
  int accepted = 0, full = 0;
  for (const PolygonSoup& soup : {star_sphere(4, 0.3, 5), cone(4000)}) {
    const AlignedBytes whole = compiled(soup, Precision::f64);
    Random random(7);
    for (int i = 0; i < 300; ++i) {
      INFO("change " << i);
      AlignedBytes file = whole;
      // A side, or a corner's fan, exchanged for another's: SAFE finds some of it, FULL the rest.
      const fdcg_section& section = section_of(file, i % 3 == 0 ? FDCG_SECTION_CORNERS : FDCG_SECTION_NODES);
      const auto record = [&](std::uint64_t n) { return file.data() + section.offset + n * section.record_bytes; };
      const auto count = static_cast<std::uint32_t>(section.record_count);
      const std::uint64_t first = i % 3 == 0 ? offsetof(fdcg_corner_f64, point) + sizeof(double[3])
                                             : offsetof(fdcg_node_f64, sides),
                          words = i % 3 == 0 ? 2 : 9;
      const std::uint64_t at = first + 4 * random.below(static_cast<std::uint32_t>(words));
      const std::uint32_t n = random.below(count);
      if (i % 20 != 0) std::memcpy(record(n) + at, record((n + 1 + random.below(3)) % count) + at, 4);
      seal(file);
      fdcg_graph graph;
      const fdcg_status status = fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr);
      CHECK(status == level_by_level(file));
      accepted += status == FDCG_OK;
      full += status != FDCG_OK && fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_SAFE, &graph, nullptr) == FDCG_OK;
    }
  }
  CHECK(accepted >= 30);
  CHECK(full > 30);
}

TEST_CASE("corners with a border that do not say so are SAFE, and harmless to press on") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    for (const PolygonSoup& soup : {plane_grid(3, 3), bumpy_patch(4, 0.3, 5), bumpy_patch(4, 0.3, 6)}) {
      AlignedBytes file = compiled(soup, precision);
      const fdcg_section& corners = section_of(file, FDCG_SECTION_CORNERS);
      const std::uint64_t fan_at =
          precision == Precision::f64 ? offsetof(fdcg_corner_f64, fan) : offsetof(fdcg_corner_f32, fan);
      std::uint32_t changed = 0;
      for (std::uint64_t v = 0; v < corners.record_count; ++v) {
        unsigned char& fan = file.data()[corners.offset + v * corners.record_bytes + fan_at];
        changed += (fan & FDCG_CORNER_OPEN) != 0;
        fan = static_cast<unsigned char>(fan & ~FDCG_CORNER_OPEN);
      }
      REQUIRE(changed > 0);
      seal(file);
      fdcg_graph graph;
      CHECK(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) != FDCG_OK);
      REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_SAFE, &graph, nullptr) == FDCG_OK);
      press_on_corners(graph);
    }
  }
}

TEST_CASE("a node of more sides than its section holds is refused, and nothing is read beyond the file") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    AlignedBytes file = compiled(prism(5), precision);
    REQUIRE(file.header().node_bytes == 0);
    const bool is_f64 = precision == Precision::f64, has_planes = (file.header().flags & FDCG_STORED_PLANES) != 0;
    const std::uint32_t real = is_f64 ? 8 : 4,
                        sides_at = is_f64 ? offsetof(fdcg_node_f64, sides) : offsetof(fdcg_node_f32, sides);
    const std::uint32_t most = FDCG_MAX_SIDES, linked = (sides_at + most * std::uint32_t{sizeof(fdcg_side)} + real - 1) / real;
    auto* const offsets = reinterpret_cast<std::uint32_t*>(file.data() + section_of(file, FDCG_SECTION_NODE_OFFSETS).offset);
    const std::uint64_t nodes_at = section_of(file, FDCG_SECTION_NODES).offset;
    const std::uint32_t n = file.header().node_count - 2;
    const auto side_count = static_cast<std::uint16_t>(most);
    std::memcpy(file.data() + nodes_at + std::uint64_t{offsets[n]} * real + sides_at - 2 * sizeof side_count, &side_count,
                sizeof side_count);
    offsets[n + 1] = offsets[n] + linked + (has_planes ? 4 * most : 0);  // where such a node would end
    REQUIRE(nodes_at + std::uint64_t{offsets[n + 1]} * real > file.size());
    seal(file);

    // The file ends where the memory ends.
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)), held = (file.size() + page - 1) / page * page;
    void* const memory = mmap(nullptr, held + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    auto* const end = static_cast<unsigned char*>(memory) + held;
    REQUIRE(mprotect(end, page, PROT_NONE) == 0);
    unsigned char* const last = end - (file.size() + 63) / 64 * 64;
    std::memcpy(last, file.data(), file.size());
    fdcg_graph graph;
    CHECK(fdcg_open_memory(last, file.size(), FDCG_VERIFY_SAFE, &graph, nullptr) == FDCG_E_GRAPH);
    munmap(memory, held + page);
  }
}
