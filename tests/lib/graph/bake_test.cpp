// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "compiled.hpp"
#include "meshes.hpp"
#include "real_meshes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

void check_cube(const WalkedGraph& graph) {
  CHECK(graph.nodes.size() == 6);
  CHECK(graph.connections.size() == 12);
  CHECK(connections_of(graph, FDCG_CONVEX) == 12);
  CHECK(graph.corners.size() == 8);
}

std::vector<PolygonSoup> all_generated() {
  return {cube(),
          grid_box(3, 4, 5, {1, 2, 3}),
          thin_plate(1e-6, 4),
          l_prism(),
          corner_pit(),
          v_groove(1.0),
          wedge(0.01),
          cone(500),
          cone_pit(40),
          saddle_block(),
          prism(64),
          prism(200),
          ico_sphere(3),
          uv_sphere(40, 20),
          torus(30, 20),
          star_sphere(3, 0.3, 1),
          plane_quad(),
          plane_grid(7, 5),
          plane_jittered(10, 2),
          bumpy_patch(10, 0.1, 3),
          spiky_sphere(2, 0.5, 4),
          needle_strip(200, 1e-3, 5),
          triangulated(cube(), 6),
          subdivided(l_prism(), 7)};
}

}  // namespace

TEST_CASE("a cube has 6 nodes, 12 convex connections and 8 corners for any triangulation, rotation and precision") {
  check_cube(compile_sound(cube()));
  check_cube(compile_sound(triangulated(cube(), 1)));
  check_cube(compile_sound(subdivided(cube(), 2)));
  check_cube(compile_sound(grid_box(5, 6, 7, {1, 1, 1})));
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    const Vec3 away = seed % 2 == 0 ? Vec3{} : Vec3{3, -2, 1};
    const PolygonSoup turned = rounded_to_float(transformed(triangulated(cube(), seed), random_rotation(seed), 1, away));
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      CompileOptions options;
      options.precision = precision;
      check_cube(compile_sound(turned, options));
      check_cube(
          compile_sound(rounded_to_float(transformed(grid_box(4, 3, 5, {1, 1, 1}), random_rotation(seed), 1, away)), options));
    }
  }
}

TEST_CASE("an object too large, too small or too far away for the format is refused, and what is compiled opens") {
  const auto compiled = [](double size, double away, Precision precision) {
    CompileOptions options;
    options.precision = precision;
    return compile(moved(scaled(cube(), size), {away, 0, 0}), options);
  };
  using enum Precision;
  for (const double size : {1e-59, 1e-9, 1.0, 1e9, 1e59})
    CHECK(compiled(size, 0, f64));
  for (const double size : {1e-8, 1.0, 1e9})
    CHECK(compiled(size, 0, f32));
  const auto refusal = [&](double size, double away, Precision precision) {
    const Result<Compiled> result = compiled(size, away, precision);
    REQUIRE_FALSE(result);
    CHECK(result.error().exit_code == 3);
    return result.error().message;
  };
  for (const double size : {1e-61, 1e61}) {
    CHECK(refusal(size, 0, f64).find("the format holds 1e-60 to 1e+60: scale the mesh") != std::string::npos);
  }
  for (const double size : {1e-10, 1e10}) {
    CHECK(refusal(size, 0, f32).find("the format holds 1e-09 to 1e+09: scale the mesh, or compile it with --precision f64") !=
          std::string::npos);
  }
  CHECK(refusal(1e90, 1e103, f64).find("from its middle") != std::string::npos);
}

TEST_CASE("an L-shaped prism has exactly one concave connection") {
  for (const PolygonSoup& soup : {l_prism(), triangulated(l_prism(), 1), subdivided(l_prism(), 2)}) {
    const WalkedGraph graph = compile_sound(soup);
    CHECK(connections_of(graph, FDCG_CONCAVE) == 1);
    CHECK(graph.euler_characteristic() == 2);
    CHECK(graph.corners.size() == 12);
  }
}

TEST_CASE("a square in one or ten thousand triangles is one node") {
  for (const PolygonSoup& soup : {plane_quad(), triangulated(plane_quad()), plane_grid(100, 50), plane_jittered(70, 1),
                                  rounded_to_float(transformed(plane_grid(100, 50), random_rotation(3)))}) {
    const WalkedGraph graph = compile_sound(soup);
    CHECK(graph.nodes.size() == 1);
    CHECK(graph.connections.size() == 4);
    CHECK(connections_of(graph, FDCG_BOUNDARY) == 4);
    CHECK(graph.corners.size() == 4);
    CHECK(std::set<std::uint32_t>(graph.source_map.begin(), graph.source_map.end()) == std::set<std::uint32_t>{0});
    CHECK(graph.source_map.size() == soup.face_count());
  }
}

TEST_CASE("every generated mesh gives a file that breaks no rule, with every option") {
  for (const PolygonSoup& soup : all_generated()) {
    for (int choice = 0; choice < 24; ++choice) {
      CompileOptions options;
      options.merge = choice % 2 == 0;
      options.precision = choice / 2 % 2 == 0 ? Precision::f64 : Precision::f32;
      options.store_planes = choice % 5 != 0;
      if (choice / 4 % 3 == 1) options.coplanar.kind = Coplanar::Kind::exact;
      if (choice / 4 % 3 == 2) options.coplanar = {Coplanar::Kind::angle, 0.05};
      if (choice % 7 == 0) options.without = {"hierarchy", "source-map", "info"};
      CAPTURE(choice);
      const PolygonSoup turned = transformed(soup, random_rotation(static_cast<std::uint64_t>(choice)), 1, {1, 2, 3});
      compile_sound(choice < 12 ? soup : turned, options);
    }
  }
}

TEST_CASE("optional sections are left out only on request") {
  CompileOptions options;
  const WalkedGraph whole = compile_sound(triangulated(cube()), options);
  CHECK(whole.voronoi.size() == whole.sides.size());
  CHECK(whole.boxes.size() == 1);
  CHECK(whole.source_map.size() == 12);
  CHECK(!whole.info.empty());
  options.without = {"hierarchy", "source-map", "info"};
  options.store_planes = false;
  const WalkedGraph lean = compile_sound(triangulated(cube()), options);
  CHECK(lean.voronoi.empty());
  CHECK(lean.boxes.empty());
  CHECK(lean.source_map.empty());
  CHECK(lean.info.empty());
}

TEST_CASE("INFO has source, options and verdict, but no path, time or threads") {
  PolygonSoup soup = triangulated(cube());
  soup.name = "/somewhere/secret-name.ply";
  CompileOptions options;
  options.metres_per_unit = 0.001;
  options.jobs = 7;
  const nlohmann::json info = nlohmann::json::parse(compile_sound(soup, options).info);
  CHECK(info["tool"] == "fdcg " FDCG_VERSION_STRING);
  CHECK(info["source"]["file_sha256"] == soup.sha256);
  CHECK(info["source"]["vertices"] == 8);
  CHECK(info["source"]["faces"] == 12);
  CHECK(info["options"]["metres_per_unit"] == 0.001);
  CHECK(info["options"]["coplanar"] == "quantum");
  CHECK(info["verdict"] == "pass");
  CHECK(info["checks"].size() > 5);
  CHECK(info["merged_faces"] == 12);
  CHECK(info.dump().find("secret") == std::string::npos);
  CHECK(!info["options"].contains("jobs"));
}

TEST_CASE("the bytes do not depend on what the memory held before, nor on whether the mesh may be consumed") {
  CompileOptions derived, floats, bare;
  derived.store_planes = false;
  floats.precision = Precision::f32;
  bare.without = {"hierarchy", "source-map", "info", "mass"};
  std::vector<std::uint64_t> memory;
  for (const PolygonSoup& soup : all_generated()) {
    for (CompileOptions options : {CompileOptions{}, derived, floats, bare}) {
      CAPTURE(soup.name);
      const Compiled fresh = compile_whole(soup, options);
      options.allocate = [&](std::size_t bytes) {
        constexpr std::size_t kAlignment = 64;
        memory.assign((bytes + kAlignment) / sizeof(std::uint64_t) + 1, 0xA5A5A5A5A5A5A5A5u);
        void* start = memory.data();
        std::size_t space = memory.size() * sizeof(std::uint64_t);
        return std::span(static_cast<std::byte*>(std::align(kAlignment, bytes, start, space)), bytes);
      };
      PolygonSoup consumed = soup;
      const auto again = compile(std::move(consumed), options);
      REQUIRE(again.has_value());
      CHECK(std::equal(fresh.bytes.begin(), fresh.bytes.end(), again->placed.begin(), again->placed.end()));
      CHECK(consumed.points.capacity() == 0);  // NOLINT(bugprone-use-after-move): what the call says of it
    }
  }
}

TEST_CASE("the bytes do not depend on the number of threads") {
  for (const PolygonSoup& soup : {star_sphere(5, 0.3, 1), subdivided(subdivided(l_prism())), cone(2000),
                                  rounded_to_float(transformed(grid_box(40, 40, 40, {1, 1, 1}), random_rotation(1)))}) {
    CompileOptions options;
    options.jobs = 1;
    const std::vector<std::byte> one = compile_whole(soup, options).bytes;
    for (const unsigned jobs : {2u, 5u}) {
      options.jobs = jobs;
      CHECK(compile_whole(soup, options).bytes == one);
    }
  }
}

TEST_CASE("a mesh with errors is refused with its report and no bytes") {
  PolygonSoup soup = cube();
  std::swap(soup.corners[0], soup.corners[2]);  // one face inside out
  const auto compiled = compile(soup, {});
  REQUIRE(compiled.has_value());
  CHECK(!compiled->report.passes());
  CHECK(compiled->bytes.empty());
  CompileOptions options;
  options.orient = true;
  const auto oriented = compile(soup, options);
  REQUIRE(oriented.has_value());
  CHECK(oriented->flipped_faces == 1);
  check_cube(read_graph(oriented->bytes));
}

TEST_CASE("a polygon that crosses itself is refused by name") {
  const PolygonSoup bow_tie = make_soup("bow tie", {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const PolygonSoup star = make_soup(
      "pentagram", {{0, 1, 0}, {-0.59, -0.81, 0}, {0.95, 0.31, 0}, {-0.95, 0.31, 0}, {0.59, -0.81, 0}}, {{0, 1, 2, 3, 4}});
  for (const PolygonSoup& soup : {bow_tie, star}) {
    const auto compiled = compile(soup, {});
    REQUIRE(compiled.has_value());
    CHECK(!compiled->report.passes());
    CHECK(compiled->bytes.empty());
    CHECK(compiled->report.issues.front().elements.front().faces == std::vector<std::uint32_t>{0});
  }
}

TEST_CASE("options that contradict one another fail as wrong usage") {
  const auto exit_code = [](auto change) {
    CompileOptions options;
    change(options);
    const auto compiled = compile(cube(), options);
    return compiled.has_value() ? 0 : compiled.error().exit_code;
  };
  CHECK(exit_code([](CompileOptions& o) { o.metres_per_unit = 0; }) == 2);
  CHECK(exit_code([](CompileOptions& o) { o.metres_per_unit = NAN; }) == 2);
  CHECK(exit_code([](CompileOptions& o) { o.metres_per_unit = 1e31; }) == 2);
  CHECK(exit_code([](CompileOptions& o) { o.metres_per_unit = 1e-31; }) == 2);
  CHECK(exit_code([](CompileOptions& o) { o.coplanar = {Coplanar::Kind::angle, 2}; }) == 2);
  CHECK(exit_code([](CompileOptions& o) { o.weld = {Weld::Kind::distance, -1}; }) == 2);
  CHECK(exit_code([](CompileOptions& o) { o.without = {"nodes"}; }) == 2);
  CHECK(exit_code([](CompileOptions&) {}) == 0);
}

TEST_CASE("the header has unit, origin, bounds and quantum") {
  PolygonSoup soup = rounded_to_float(transformed(cube(), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 2, {1000, 0, 0}));
  CompileOptions options;
  options.metres_per_unit = 0.0254;
  const fdcg_header header = compile_sound(soup, options).header;
  CHECK(header.metres_per_unit == 0.0254);
  CHECK(header.origin[0] == 1000);
  CHECK(header.bounds_min[0] == -1);
  CHECK(header.bounds_max[2] == 1);
  CHECK(header.extent == 1);
  CHECK(header.quantum == 1001 * 0x1p-24);
  CHECK(header.source_vertex_count == 8);
  CHECK(header.source_face_count == 6);
}

TEST_CASE("the source map names a node that a face's centre lies on") {
  for (const PolygonSoup& soup : {triangulated(subdivided(l_prism()), 1), grid_box(6, 5, 4, {1, 1, 1}), star_sphere(3, 0.2, 1),
                                  subdivided(subdivided(voxels("stairs", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})))}) {
    const WalkedGraph graph = compile_sound(soup);
    REQUIRE(graph.source_map.size() == soup.face_count());
    for (std::size_t f = 0; f < soup.face_count(); ++f) {
      Vec3 centre;
      const auto corners = face_corners(soup, f);
      for (const std::uint32_t v : corners) {
        const Vec3& p = soup.points[v];
        const double n = static_cast<double>(corners.size());
        centre = {centre.x + p.x / n, centre.y + p.y / n, centre.z + p.z / n};
      }
      const WalkedNode& node = graph.nodes[graph.source_map[f]];
      const double local[3] = {centre.x - graph.header.origin[0], centre.y - graph.header.origin[1],
                               centre.z - graph.header.origin[2]};
      const auto distance = [&](const fdcg_plane_f64& p) {
        return p.normal[0] * local[0] + p.normal[1] * local[1] + p.normal[2] * local[2] + p.offset;
      };
      CHECK(std::fabs(distance(node.plane)) < 1e-12);
      for (std::uint32_t s = 0; s < node.side_count; ++s)
        CHECK(distance(graph.voronoi[node.first_side + s]) < 1e-12);
    }
  }
}

TEST_CASE("every valid real mesh available gives a file that breaks no rule") {
  std::size_t compiled_meshes = 0;
  for (const PolygonSoup& soup : real_meshes()) {
    const auto compiled = compile(soup, {});
    REQUIRE(compiled.has_value());
    if (!compiled->report.passes()) continue;
    INFO(soup.name);
    CHECK(defects_text(compiled->bytes) == "");
    ++compiled_meshes;
  }
  WARN("real meshes compiled: " << compiled_meshes);
}
