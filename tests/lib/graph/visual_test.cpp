// SPDX-License-Identifier: Apache-2.0
// The mesh for the eye: what fdcg compile --visual writes, and what fdcg_get_visual takes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>

#include "catch.hpp"
#include "compiled.hpp"
#include "fdcg/visual.h"
#include "gltf_writer.hpp"
#include "meshes.hpp"
#include "scratch_folder.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

ImportOptions looking() {
  ImportOptions import;
  import.normals = import.appearance = true;
  return import;
}

CompileOptions seen(double crease_rad = kDefaultCrease_rad) {
  CompileOptions options;
  options.visual = true;
  options.crease_rad = crease_rad;
  return options;
}

struct Seen {
  AlignedBytes file;
  fdcg_graph graph{};
  fdcg_visual visual{};
  fdcg_error error{};
  fdcg_status status;

  explicit Seen(std::span<const std::byte> bytes) : file(bytes) {
    REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
    status = fdcg_get_visual(&graph, &visual, &error);
  }
  [[nodiscard]] const fdcg_visual_vertex& corner(std::uint32_t triangle, std::uint32_t k) const {
    return visual.vertices[visual.indices[3 * triangle + k]];
  }
  [[nodiscard]] std::uint32_t triangles() const { return visual.index_count / 3; }
  [[nodiscard]] const fdcg_visual_material& material(std::uint32_t m) const { return visual.materials[m]; }
};

Vec3 normal_of(const fdcg_visual_vertex& vertex) {
  constexpr double kUnit = 1.0 / FDCG_NORMAL_SCALE;
  return {kUnit * vertex.normal[0], kUnit * vertex.normal[1], kUnit * vertex.normal[2]};
}

// That each triangle lies on the plane of the node it names, and is wound like it.
void check_nodes(const Seen& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
    REQUIRE(mesh.visual.nodes[t] != FDCG_NONE);
    const fdcg_node_info node = fdcg_get_node(&mesh.graph, mesh.visual.nodes[t]);
    double edge[2][3], normal[3];
    for (int k = 0; k < 3; ++k) {
      for (int e = 0; e < 2; ++e)
        edge[e][k] = double{mesh.corner(t, 1 + e).position[k]} - mesh.corner(t, 0).position[k];
    }
    for (int k = 0; k < 3; ++k)
      normal[k] = edge[0][(k + 1) % 3] * edge[1][(k + 2) % 3] - edge[0][(k + 2) % 3] * edge[1][(k + 1) % 3];
    double along = 0, size = 0, height = node.offset;
    for (int k = 0; k < 3; ++k) {
      along += normal[k] * node.normal[k], size += normal[k] * normal[k];
      height += node.normal[k] * mesh.corner(t, 0).position[k];
    }
    CHECK(along >= 0.9999 * std::sqrt(size));
    CHECK(std::fabs(height) < 1e-5 * mesh.graph.header->extent);
  }
}

constexpr const char* kTetrahedron =
    "mtllib paint.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "vt 0 0\nvt 1 0\nvt 0.5 0.75\n"
    "usemtl red\nf 1/1 3/2 2/3\nf 1/1 2/2 4/3\n"
    "usemtl of no library\nf 2 3 4\n"
    "usemtl red\nf 1/1 4/-2 3/9\n";

}  // namespace

TEST_CASE("a smooth mesh has one vertex a corner, with its normal") {
  for (const PolygonSoup& soup : {ico_sphere(3), uv_sphere(12, 7)}) {
    const Seen mesh(compile_whole(soup, seen(1)).bytes);
    REQUIRE(mesh.status == FDCG_OK);
    CHECK(mesh.visual.vertex_count == mesh.graph.header->corner_count);
    REQUIRE(mesh.visual.material_count == 1);
    CHECK(mesh.material(0).name[0] == '\0');
    CHECK(mesh.material(0).flags == 0);
    double worst = 0;
    for (std::uint32_t v = 0; v < mesh.visual.vertex_count; ++v) {
      const fdcg_visual_vertex& vertex = mesh.visual.vertices[v];
      const fdcg_corner_info corner = fdcg_get_corner(&mesh.graph, v);
      const Vec3 normal = normal_of(vertex);
      double along = 0, size = 0;
      const double parts[3] = {normal.x, normal.y, normal.z};
      for (int k = 0; k < 3; ++k) {
        CHECK(vertex.position[k] == static_cast<float>(corner.point[k]));
        const double out = corner.point[k] + mesh.visual.origin[k];
        along += out * parts[k], size += out * out;
      }
      worst = std::max(worst, 1 - along / std::sqrt(size));
    }
    CHECK(worst < 1e-4);
    check_nodes(mesh);
  }
}

TEST_CASE("vertices are doubled at creases alone, and triangles are the mesh file's own where faces were merged") {
  const PolygonSoup soup = grid_box(4, 3, 2, {4, 3, 2});
  const Seen mesh(compile_whole(soup, seen()).bytes);
  REQUIRE(mesh.status == FDCG_OK);
  CHECK(mesh.graph.header->node_count == 6);
  CHECK(mesh.graph.header->corner_count == 8);
  CHECK(mesh.triangles() == 2 * 2 * (4 * 3 + 3 * 2 + 4 * 2));
  // of each side of the box the points of its grid
  CHECK(mesh.visual.vertex_count == 2 * (5 * 4 + 4 * 3 + 5 * 3));
  std::uint32_t doubled = 0, inside = 0;
  for (std::uint32_t v = 8; v < mesh.visual.vertex_count; ++v)
    (mesh.visual.vertices[v].corner == FDCG_NONE ? inside : doubled) += 1;
  CHECK(doubled == 16);
  CHECK(inside == mesh.visual.vertex_count - 24);
  check_nodes(mesh);
}

TEST_CASE("texture coordinates and materials of OBJ, with their library") {
  const std::filesystem::path folder = scratch_folder() / "model";
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "part.obj") << kTetrahedron;
  std::ofstream(folder / "paint.mtl") << "newmtl blue\nKd 0 0 1\nnewmtl red # bright\nNs 3\nKd 1 0.25 0\nd 0.5\n"
                                         "newmtl red\nKd 1 1 0\nmap_Kd red.png\n"
                                         "newmtl red # bright\nKd 0.5 spectral\n";
  auto soup = import_mesh(folder / "part.obj", looking());
  REQUIRE(soup);
  CHECK(soup->other_files == std::vector<std::string>{(folder / "paint.mtl").string()});
  REQUIRE(soup->appearance.materials.size() == 2);
  CHECK(soup->appearance.materials[0].base_colour == Colour{1, 1, 0, 1});
  CHECK(soup->appearance.materials[1].base_colour == Colour{1, 1, 1, 1});
  CHECK(soup->appearance.uv[2] == std::array<float, 2>{0.5, 0.25});  // v turned
  CHECK(soup->appearance.uv[10] == std::array<float, 2>{1, 1});      // counted back
  CHECK(std::isnan(soup->appearance.uv[11][0]));                     // there is no ninth
  CHECK(std::isnan(soup->appearance.uv[6][0]));
  const Seen mesh(compile_whole(*soup, seen()).bytes);
  REQUIRE(mesh.status == FDCG_OK);
  REQUIRE(mesh.visual.material_count == 2);
  CHECK(mesh.material(0).name == std::string("red"));
  CHECK(mesh.material(0).index_count == 9);
  CHECK(mesh.material(0).flags == FDCG_VISUAL_UV);
  CHECK(mesh.material(0).base_colour[2] == 0);
  CHECK(mesh.material(1).name == std::string("of no library"));
  CHECK(mesh.material(1).first_index == 9);
  CHECK(mesh.material(1).flags == 0);
  check_nodes(mesh);
  std::set<std::pair<float, float>> places;
  for (std::uint32_t t = 0; t < 3; ++t)
    for (std::uint32_t k = 0; k < 3; ++k)
      places.insert({mesh.corner(t, k).uv[0], mesh.corner(t, k).uv[1]});
  CHECK(places == std::set<std::pair<float, float>>{{0, 0}, {0, 1}, {0.5, 0.25}, {1, 1}});

  std::filesystem::remove(folder / "paint.mtl");
  soup = import_mesh(folder / "part.obj", looking());
  REQUIRE(soup);
  CHECK(soup->appearance.materials[0].base_colour == Colour{1, 1, 1, 1});
  REQUIRE(soup->unread_files.size() == 1);
  CHECK_THAT(soup->unread_files[0], Catch::Contains("'paint.mtl' is not there"));
  std::ofstream(folder.parent_path() / "outside.mtl") << "newmtl red\nKd 0 0 0\n";
  std::ofstream(folder / "outside.obj") << "mtllib ../outside.mtl\n" << (kTetrahedron + 17);
  soup = import_mesh(folder / "outside.obj", looking());
  REQUIRE(soup);
  REQUIRE(soup->unread_files.size() == 1);
  CHECK_THAT(soup->unread_files[0], Catch::Contains("'../outside.mtl' was not read"));
  CHECK(soup->appearance.materials[0].base_colour == Colour{1, 1, 1, 1});
  CHECK(import_mesh(folder / "part.obj")->appearance.uv.empty());
  CHECK(import_memory(kTetrahedron, "memory.obj", looking())->other_files.empty());
  const auto cut_short = import_memory("v 0 0 0\nvt\nf 1 1 1\n", "short.obj", looking());
  REQUIRE(!cut_short);
  CHECK(cut_short.error().message.find("line 2: a texture coordinate needs a number") != std::string::npos);
}

TEST_CASE("colours of OBJ and PLY are those of a screen, and opacity is as it is") {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const auto obj = import_memory("v 0 0 0 1 0 0.5\nv 1 0 0 1 0 1 1\nv 0 1 0 0.2\nv 0 0 1 0 0 0\n" + faces, "c.obj", looking());
  REQUIRE(obj);
  REQUIRE(obj->appearance.colours.size() == 12);
  CHECK(obj->appearance.colours[0][0] == 1);
  CHECK(obj->appearance.colours[0][2] == Approx(0.2140411));
  CHECK(obj->appearance.colours[2] == Colour{0, 1, 1, 1});  // after its weight
  CHECK(obj->appearance.colours[1] == Colour{1, 1, 1, 1});  // of a weight alone

  const std::string head =
      "element vertex 4\nproperty uchar red\nproperty float x\nproperty float y\nproperty float z\nproperty uchar green\n"
      "property uchar blue\nproperty uchar alpha\nproperty float s\nproperty float t\nelement face 4\n"
      "property list uchar int vertex_indices\nend_header\n";
  std::string text = "ply\nformat ascii 1.0\n" + head, binary = "ply\nformat binary_little_endian 1.0\n" + head;
  const float points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int order[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const auto put = [&binary](auto value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (int v = 0; v < 4; ++v) {
    const auto red = static_cast<std::uint8_t>(60 * v), alpha = static_cast<std::uint8_t>(255 - v);
    const float s = 0.25f * static_cast<float>(v), t = 0.125f;
    text += std::to_string(red);
    put(red);
    for (const float p : points[v])
      text += ' ' + std::to_string(static_cast<int>(p)), put(p);
    text += " 255 128 " + std::to_string(alpha) + ' ' + std::to_string(s) + " 0.125\n";
    put(std::uint8_t{255}), put(std::uint8_t{128}), put(alpha), put(s), put(t);
  }
  for (const auto& face : order) {
    text += "3";
    put(std::uint8_t{3});
    for (const int corner : face)
      text += ' ' + std::to_string(corner), put(std::int32_t{corner});
    text += '\n';
  }
  for (const std::string& bytes : {text, binary}) {
    const auto soup = import_memory(bytes, "c.ply", looking());
    REQUIRE(soup);
    CHECK(import_memory(bytes, "c.ply")->appearance.colours.empty());
    const Seen mesh(compile_whole(*soup, seen()).bytes);
    REQUIRE(mesh.status == FDCG_OK);
    CHECK(mesh.material(0).flags == (FDCG_VISUAL_UV | FDCG_VISUAL_COLOURS));
    for (std::uint32_t v = 0; v < mesh.visual.vertex_count; ++v) {
      const fdcg_visual_vertex& vertex = mesh.visual.vertices[v];
      const fdcg_corner_info corner = fdcg_get_corner(&mesh.graph, vertex.corner);
      double at[3];
      for (int k = 0; k < 3; ++k)
        at[k] = corner.point[k] + mesh.visual.origin[k];
      const auto number = static_cast<int>(std::lround(at[0] + 2 * at[1] + 3 * at[2]));
      const double shares[4] = {0, 0.0451862, 0.1878208, 0.4563918};  // of 0, 60, 120, 180
      CHECK(std::abs(vertex.colour[0] - std::lround(65535 * shares[number])) <= 1);
      CHECK(vertex.colour[1] == 65535);
      CHECK(vertex.colour[3] == std::lround(65535 * (1 - number / 255.0)));
      CHECK(vertex.uv[0] == 0.25f * static_cast<float>(number));
      CHECK(vertex.uv[1] == 0.875f);
    }
  }
}

TEST_CASE("glTF's texture coordinates, colours and base colours") {
  std::string buffer;
  const auto put = [&buffer](auto value) { buffer.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f})
    put(number);
  for (const std::uint16_t index : {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2})
    put(index);
  for (const std::uint16_t uv : {0, 0, 65535, 0, 0, 65535, 65535, 65535})
    put(uv);
  for (const float colour : {0.5f, 0.f, 1.f, 1.f, 1.f, 1.f, 0.f, 0.f, 0.f, 2.f, -1.f, 0.25f})
    put(colour);
  const std::string json =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],
      "materials":[{"name":"unused"},{"name":"brass","pbrMetallicRoughness":{"baseColorFactor":[0.8,0.5,0.25,1]}}],
      "meshes":[{"primitives":[{"material":1,"indices":1,"attributes":{"POSITION":0,"TEXCOORD_0":2,"COLOR_0":3}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4},
      {"bufferView":1,"componentType":5123,"type":"SCALAR","count":12},
      {"bufferView":2,"componentType":5123,"normalized":true,"type":"VEC2","count":4},
      {"bufferView":3,"componentType":5126,"type":"VEC3","count":4}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24},
      {"buffer":0,"byteOffset":72,"byteLength":16},{"buffer":0,"byteOffset":88,"byteLength":48}],
      "buffers":[{"byteLength":136,"uri":"data:application/octet-stream;base64,)" +
      base64(buffer) + "\"}]}";
  const auto soup = import_memory(json, "brass.gltf", looking());
  REQUIRE(soup);
  const Seen mesh(compile_whole(*soup, seen()).bytes);
  REQUIRE(mesh.status == FDCG_OK);
  REQUIRE(mesh.visual.material_count == 1);
  CHECK(mesh.material(0).name == std::string("brass"));
  CHECK(mesh.material(0).base_colour[2] == 0.25f);
  CHECK(mesh.material(0).flags == (FDCG_VISUAL_UV | FDCG_VISUAL_COLOURS));
  for (std::uint32_t v = 0; v < mesh.visual.vertex_count; ++v) {
    const fdcg_visual_vertex& vertex = mesh.visual.vertices[v];
    const fdcg_corner_info corner = fdcg_get_corner(&mesh.graph, vertex.corner);
    const double x = corner.point[0] + mesh.visual.origin[0], z = corner.point[2] + mesh.visual.origin[2];
    CHECK(vertex.uv[0] == (x + z > 0.5 ? 1 : 0));
    if (z > 0.5) CHECK((vertex.colour[0] == 65535 && vertex.colour[1] == 0 && vertex.colour[2] == 16384));
  }
  const auto broken = [&json](const std::string& from, const std::string& to) {
    std::string changed = json;
    changed.replace(changed.find(from), from.size(), to);
    return import_memory(changed, "broken.gltf", looking());
  };
  CHECK(!broken("\"VEC2\"", "\"VEC3\""));
  CHECK(!broken("\"TEXCOORD_0\":2", "\"TEXCOORD_0\":9"));
  const auto short_uv = broken(R"("normalized":true,"type":"VEC2","count":4)", R"("normalized":true,"type":"VEC2","count":3)");
  REQUIRE(short_uv);
  CHECK(short_uv->appearance.uv.empty());
  CHECK(short_uv->ignored.size() == 1);
  CHECK(broken("[0.8,0.5,0.25,1]", "[0.8,0.5]"));  // no colour refuses a mesh
}

TEST_CASE("a mesh for the eye is no part of a file unless it is asked for, and the graph is the same with it") {
  const PolygonSoup soup = ico_sphere(2);
  const std::vector<std::byte> with = compile_whole(soup, seen()).bytes;
  CompileOptions plain;
  plain.without = {"info"};
  const Seen without(compile_whole(soup, plain).bytes), both(with);
  CHECK(without.status == FDCG_E_ABSENT);
  CHECK(without.visual.vertices == nullptr);
  CHECK(std::string(without.error.message).find("--visual") != std::string::npos);
  fdcg_visual none{};
  CHECK(fdcg_get_visual(nullptr, &none, nullptr) == FDCG_E_ARGUMENT);
  CHECK(fdcg_get_visual(&both.graph, nullptr, nullptr) == FDCG_E_ARGUMENT);
  const std::uint64_t nodes = without.graph.header->node_count * std::uint64_t{without.graph.header->node_bytes};
  CHECK(std::memcmp(without.graph.nodes, both.graph.nodes, nodes) == 0);
  for (const unsigned jobs : {1u, 2u, 5u}) {
    CompileOptions options = seen();
    options.jobs = jobs;
    CHECK(compile_whole(soup, options).bytes == with);
  }
}

TEST_CASE("what is wrong with a mesh for the eye is refused by name") {
  const auto soup = import_memory(kTetrahedron, "four.obj", looking());
  REQUIRE(soup);
  const std::vector<std::byte> good = compile_whole(*soup, seen()).bytes;
  const auto damaged = [&good](const std::function<void(fdcg_visual&)>& change) {
    Seen mesh(good);
    change(mesh.visual);
    seal(mesh.file);
    fdcg_graph graph;
    fdcg_visual visual;
    fdcg_error error{};
    REQUIRE(fdcg_open_memory(mesh.file.data(), mesh.file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
    const fdcg_status status = fdcg_get_visual(&graph, &visual, &error);
    CHECK((status == FDCG_OK) == (visual.vertices != nullptr));
    if (status != FDCG_OK) CHECK(status == FDCG_E_GRAPH);
    return std::string(status == FDCG_OK ? "fine" : error.message);
  };
  const auto vertex = [](fdcg_visual& v, std::uint32_t i) { return const_cast<fdcg_visual_vertex*>(v.vertices) + i; };
  const auto material = [](fdcg_visual& v, std::uint32_t i) { return const_cast<fdcg_visual_material*>(v.materials) + i; };
  const auto says = [](const std::string& message, const char* words) { return message.find(words) != std::string::npos; };
  CHECK(damaged([](fdcg_visual&) {}) == "fine");
  CHECK(says(damaged([&](fdcg_visual& v) { vertex(v, 1)->position[2] = NAN; }), "visual vertex 1: a number is not finite"));
  CHECK(says(damaged([&](fdcg_visual& v) { vertex(v, 2)->uv[1] = INFINITY; }), "vertex 2: a number is not finite"));
  CHECK(says(damaged([&](fdcg_visual& v) { vertex(v, 3)->normal[0] = vertex(v, 3)->normal[1] = vertex(v, 3)->normal[2] = 9; }),
             "unit length"));
  CHECK(says(damaged([&](fdcg_visual& v) { vertex(v, 3)->normal[3] = 1; }), "unit length"));
  CHECK(says(damaged([&](fdcg_visual& v) { vertex(v, 0)->corner = 1; }), "vertex 0: corner out of range"));
  CHECK(says(damaged([&](fdcg_visual& v) { vertex(v, 0)->corner = FDCG_NONE; }), "corner out of range"));
  CHECK(says(damaged([&](fdcg_visual& v) { vertex(v, 5)->corner = 4; }), "vertex 5: corner out of range"));
  CHECK(damaged([&](fdcg_visual& v) { vertex(v, 5)->corner = FDCG_NONE; }) == "fine");
  CHECK(says(damaged([](fdcg_visual& v) { const_cast<std::uint32_t*>(v.indices)[11] = v.vertex_count; }),
             "visual index 11: vertex out of range"));
  CHECK(says(damaged([](fdcg_visual& v) { const_cast<std::uint32_t*>(v.nodes)[3] = 4; }), "triangle 3: node out of range"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 0)->base_colour[1] = 1.5f; }), "base colour"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 0)->base_colour[1] = NAN; }), "base colour"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 1)->name[63] = 'x'; }), "material 1: its name"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 1)->flags = 4; }), "unknown flags"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 1)->reserved = 1; }), "unknown flags"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 0)->index_count = 6; }), "do not follow"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 1)->index_count = 0; }), "not all there"));
  CHECK(says(damaged([&](fdcg_visual& v) { material(v, 0)->index_count = 0xFFFFFFFDu; }), "not all there"));

  const auto relabelled = [&good](std::uint32_t id, auto change) {
    AlignedBytes file(good);
    auto* const table = reinterpret_cast<fdcg_section*>(file.data() + sizeof(fdcg_header));
    for (std::uint32_t i = 0; i < file.header().section_count; ++i)
      if (table[i].id == id) change(table[i]);
    seal(file);
    fdcg_graph graph;
    fdcg_visual visual;
    if (fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_SAFE, &graph, nullptr) != FDCG_OK) return FDCG_E_LAYOUT;
    return fdcg_get_visual(&graph, &visual, nullptr);
  };
  for (std::uint32_t id = 17; id <= 20; ++id) {
    CHECK(relabelled(id, [](fdcg_section&) {}) == FDCG_OK);
    CHECK(relabelled(id, [](fdcg_section& s) { s.record_bytes *= 2, s.record_count /= 2; }) != FDCG_OK);
    CHECK(relabelled(id, [](fdcg_section& s) { s.record_count = 0; }) != FDCG_OK);
  }
  CHECK(relabelled(20, [](fdcg_section& s) { s.id = 40; }) == FDCG_E_GRAPH);
}
