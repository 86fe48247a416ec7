// SPDX-License-Identifier: Apache-2.0
// What FDCG_VERIFY_SAFE lets through and FDCG_VERIFY_FULL does not: files that are no surface. A step on one may say anything,
// but nothing undefined, and its numbers are numbers.
#include <cmath>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
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

}  // namespace

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
