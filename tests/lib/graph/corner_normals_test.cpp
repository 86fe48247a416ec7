// SPDX-License-Identifier: Apache-2.0
// The section NODE_NORMALS: what fdcg compile writes into it, and what a reader takes.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "compiled.hpp"
#include "meshes.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

CompileOptions with_normals(double crease_rad = kDefaultCrease_rad) {
  CompileOptions options;
  options.normals = Normals::faces;
  options.crease_rad = crease_rad;
  return options;
}

struct Opened {
  AlignedBytes file;
  fdcg_graph graph{};
  fdcg_error error{};
  fdcg_status status;

  Opened(std::span<const std::byte> bytes, fdcg_verify verify) : file(bytes) {
    status = fdcg_open_memory(file.data(), file.size(), verify, &graph, &error);
  }
};

Vec3 normal_of(const fdcg_graph& graph, std::uint32_t node, std::uint32_t k) {
  double normals[9];
  fdcg_get_node_normals(&graph, node, normals);
  return {normals[3 * k], normals[3 * k + 1], normals[3 * k + 2]};
}

double dot3(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace

TEST_CASE("on a sphere the normals are the sphere's, up to their code") {
  for (const PolygonSoup& soup : {ico_sphere(1), ico_sphere(3), geodesic_sphere(5), uv_sphere(12, 7)}) {
    const Opened mesh(compile_whole(soup, with_normals(1)).bytes, FDCG_VERIFY_FULL);
    REQUIRE(mesh.status == FDCG_OK);
    REQUIRE(mesh.graph.normals != nullptr);
    double worst = 0;
    for (std::uint32_t n = 0; n < mesh.graph.header->node_count; ++n) {
      double normals[9];
      if (fdcg_get_node_normals(&mesh.graph, n, normals) == 0) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const fdcg_corner_info corner = fdcg_get_corner(&mesh.graph, fdcg_get_side(&mesh.graph, n, k).corner);
        const double* const o = mesh.graph.header->origin;
        const Vec3 radial = {corner.point[0] + o[0], corner.point[1] + o[1], corner.point[2] + o[2]};
        const Vec3 found = normal_of(mesh.graph, n, k);
        worst = std::max(worst, std::acos(std::min(1.0, dot3(found, radial) / std::sqrt(dot3(radial, radial)))));
      }
    }
    INFO(soup.name << ": off by up to " << worst << " rad");
    CHECK(worst <= 6e-5);
  }
}

TEST_CASE("creases stay sharp, flat faces flat and merged") {
  CompileOptions bare, bare_with_normals = with_normals();
  bare.without = bare_with_normals.without = {"info"};
  const Compiled plain = compile_whole(cube(), bare), shaded = compile_whole(cube(), bare_with_normals);
  CHECK(plain.bytes == shaded.bytes);  // nothing is there to be shaded
  CHECK(shaded.shaded_faces == 0);

  const Opened mesh(compile_whole(prism(24), with_normals()).bytes, FDCG_VERIFY_FULL);
  REQUIRE(mesh.status == FDCG_OK);
  REQUIRE(mesh.graph.normals != nullptr);
  std::uint32_t walls = 0, caps = 0;
  for (std::uint32_t n = 0; n < mesh.graph.header->node_count; ++n) {
    const fdcg_node_info node = fdcg_get_node(&mesh.graph, n);
    double normals[9];
    const bool is_shaded = fdcg_get_node_normals(&mesh.graph, n, normals) != 0;
    if (std::fabs(node.normal[2]) > 0.5) {
      CHECK(!is_shaded);
      ++caps;
    } else {
      CHECK(is_shaded);
      CHECK(node.side_count == 3);
      for (std::uint32_t k = 0; k < 3; ++k)
        CHECK(std::fabs(normal_of(mesh.graph, n, k).z) < 1e-4);  // no cap counts
      ++walls;
    }
  }
  CHECK(walls == 48);
  CHECK(caps <= 8);  // 44 triangles, merged

  CHECK(compile_whole(prism(24), with_normals(0.1)).shaded_faces == 0);  // every edge of 15 degrees is a crease
}

TEST_CASE("normals are of no mesh that has none, nor where they are left out") {
  CompileOptions options = with_normals();
  options.normals = Normals::file;
  const auto refused = compile(ico_sphere(1), options);
  REQUIRE(!refused);
  CHECK(refused.error().exit_code == 2);
  CHECK(refused.error().message.find("holds no normals") != std::string::npos);
  CompileOptions without = with_normals();
  without.without = {"normals"};
  CHECK(compile_whole(ico_sphere(2), without).shaded_faces == 0);
  const Opened mesh(compile_whole(ico_sphere(2), without).bytes, FDCG_VERIFY_FULL);
  CHECK(mesh.graph.normals == nullptr);
}

TEST_CASE("an OBJ file's own normals are taken, also those that stand after the faces") {
  const char* const text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
      "f 1//1 3//1 2//1\nf 1/7/-1 2//2 4//3\nf 2//2 3//9 4\nf 1//2 4//2 3//2\n"
      "vn 0 0 -2\nvn 0.5 -1 0.3\nvn 0 -1 1\n";
  ImportOptions import;
  import.normals = true;
  const auto soup = import_memory(text, "four.obj", import);
  REQUIRE(soup);
  REQUIRE(soup->corner_normals.size() == 12);
  CHECK(soup->corner_normals[0] == Vec3{0, 0, -2});
  CHECK(soup->corner_normals[4] == Vec3{0.5, -1, 0.3});
  CHECK(soup->corner_normals[5] == Vec3{0, -1, 1});
  CHECK(soup->corner_normals[3] == Vec3{});  // counted back from the latest, of which there was none yet
  CHECK(soup->corner_normals[7] == Vec3{});  // there is no ninth
  CHECK(soup->corner_normals[8] == Vec3{});  // none is named
  CHECK(import_memory(text, "four.obj")->corner_normals.empty());

  CompileOptions options;
  options.normals = Normals::file;
  const Compiled compiled = compile_whole(*soup, options);
  CHECK(compiled.unusable_normals == 4);  // face 4's three, and one of face 3 lean by more than 60 degrees
  const Opened mesh(compiled.bytes, FDCG_VERIFY_FULL);
  REQUIRE(mesh.status == FDCG_OK);
  REQUIRE(mesh.graph.normals != nullptr);

  const auto cut_short = import_memory("v 0 0 0\nvn 1 2\nf 1 1 1\n", "short.obj", import);
  REQUIRE(!cut_short);
  CHECK(cut_short.error().message.find("line 2: a normal needs three numbers") != std::string::npos);
}

TEST_CASE("normals that no writer writes are refused, or harmless") {
  const std::vector<std::byte> good = compile_whole(prism(24), with_normals()).bytes;
  const auto damaged = [&](auto change) {
    Opened trusted(good, FDCG_VERIFY_TRUSTED);
    auto* const normals = const_cast<fdcg_node_normals*>(trusted.graph.normals);
    change(trusted.graph, normals);
    seal(trusted.file);
    fdcg_graph graph;
    fdcg_error error{};
    const fdcg_status status = fdcg_open_memory(trusted.file.data(), trusted.file.size(), FDCG_VERIFY_SAFE, &graph, &error);
    if (status == FDCG_OK) touch_everywhere(graph, 20000);
    return std::string(status == FDCG_OK ? "" : error.message);
  };
  CHECK(damaged([](const fdcg_graph&, fdcg_node_normals*) {}).empty());
  CHECK(damaged([](const fdcg_graph&, fdcg_node_normals* n) {
          n[0].corner[1][0] = 1, n[0].corner[1][1] = 0xffff;
        }).find("half a code") != std::string::npos);
  CHECK(damaged([](const fdcg_graph& graph, fdcg_node_normals* n) {
          std::uint32_t polygon = 0;
          while (fdcg_get_node(&graph, polygon).side_count == 3)
            ++polygon;
          n[polygon].corner[0][0] = n[polygon].corner[0][1] = 5;
        }).find("more than three") != std::string::npos);
  CHECK(damaged([](const fdcg_graph& graph, fdcg_node_normals* n) {
          std::uint32_t random = 1;
          for (std::uint32_t i = 0; i < graph.header->node_count; ++i) {
            if (fdcg_get_node(&graph, i).side_count != 3) continue;
            for (auto& code : n[i].corner)
              for (std::uint16_t& number : code)
                number = static_cast<std::uint16_t>((random = random * 1664525u + 1013904223u) >> 16) & 0xfffe;
          }
        }).empty());
}
