// SPDX-License-Identifier: Apache-2.0
// Materials from the mesh file to the graph: kept by every stage, and refused where a file's are out of range.
#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "catch.hpp"
#include "gltf_writer.hpp"
#include "materials_rig.hpp"
#include "random.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::test;
namespace bake = fdcg::bake;

TEST_CASE("usemtl is kept from the mesh file to the nodes, and faces of two materials are not merged") {
  const bake::PolygonSoup soup = imported(kStrip);
  CHECK(soup.materials == std::vector<std::string>{"rubber", "ice"});
  CHECK(soup.face_material == std::vector<std::uint16_t>{0, 1});
  bake::CompileOptions options;
  const CompiledMesh mesh(soup, options);
  REQUIRE(mesh.view().header->node_count == 2);
  REQUIRE(mesh.view().material_count == 2);
  CHECK(fdcg_find_material(&mesh.view(), "ice") == 1);
  CHECK(fdcg_find_material(&mesh.view(), "ic") == FDCG_NONE);
  CHECK(fdcg_get_material_name(&mesh.view(), 2) == nullptr);
  for (std::uint32_t f = 0; f < 2; ++f)
    CHECK(fdcg_get_node_material(&mesh.view(), mesh.view().source_map[f]) == f);
  int flat = 0;
  for (std::uint32_t c = 0; c < mesh.view().header->connection_count; ++c)
    flat += fdcg_get_connection(&mesh.view(), c).type == FDCG_COPLANAR;
  CHECK(flat == 1);
  options.without = {"materials"};
  const CompiledMesh merged(soup, options);
  CHECK(merged.view().header->node_count == 1);
  CHECK(merged.view().node_materials == nullptr);
  CHECK(fdcg_get_node_material(&merged.view(), 0) == FDCG_NONE);
}

TEST_CASE("a mesh without materials has no section of them; faces before the first usemtl have none") {
  CHECK(CompiledMesh(cube()).view().node_materials == nullptr);
  const bake::PolygonSoup soup =
      imported("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nusemtl  felt, grey \nf 2 3 4\nusemtl\nf 1 4 3\n");
  const CompiledMesh mesh(soup);
  REQUIRE(mesh.view().material_count == 1);
  CHECK_THAT(fdcg_get_material_name(&mesh.view(), 0), Catch::Matchers::Equals("felt, grey"));
  const std::uint32_t expected[] = {FDCG_NONE, FDCG_NONE, 0, FDCG_NONE};
  for (std::uint32_t f = 0; f < 4; ++f)
    CHECK(fdcg_get_node_material(&mesh.view(), mesh.view().source_map[f]) == expected[f]);
}

TEST_CASE("with any merging, each source face's node has its material, and parts of a plane share it bit for bit") {
  Random random(4);
  for (int round = 0; round < 6; ++round) {
    const Rotation tilt = random_rotation(static_cast<std::uint64_t>(round));
    const PolygonSoup body = transformed(triangulated(grid_box(6, 5, 4, {3, 2, 1})), tilt);
    const bake::PolygonSoup soup = painted(body, {"a", "b", "c"}, [&](std::size_t, const Hip& middle, const Hip&) {
      // patches, so that there is something to merge, with ragged rims; some faces of none
      const double at = std::sin(3 * middle[0]) + std::sin(4 * middle[1] + 1) + 0.1 * random.uniform(-1, 1);
      return at > 0.8  ? std::uint16_t{0}
             : at > 0  ? std::uint16_t{1}
             : at > -1 ? std::uint16_t{2}
                       : bake::PolygonSoup::kNoMaterial;
    });
    for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
      bake::CompileOptions options;
      options.precision = precision;
      const CompiledMesh mesh(soup, options);
      const fdcg_graph& graph = mesh.view();
      CHECK(graph.header->node_count < soup.face_count());
      for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
        const std::uint32_t expected =
            soup.face_material[f] == bake::PolygonSoup::kNoMaterial ? FDCG_NONE : soup.face_material[f];
        REQUIRE(fdcg_get_node_material(&graph, graph.source_map[f]) == expected);
      }
      int between = 0;
      for (std::uint32_t c = 0; c < graph.header->connection_count; ++c) {
        const fdcg_connection_info edge = fdcg_get_connection(&graph, c);
        if (fdcg_get_node_material(&graph, edge.node[0]) == fdcg_get_node_material(&graph, edge.node[1])) continue;
        if (edge.type != FDCG_COPLANAR) continue;
        const fdcg_node_info a = fdcg_get_node(&graph, edge.node[0]), b = fdcg_get_node(&graph, edge.node[1]);
        ++between;
        REQUIRE(std::memcmp(a.normal, b.normal, sizeof a.normal) == 0);
        REQUIRE(a.offset == b.offset);
      }
      CHECK(between > 20);
    }
  }
}

TEST_CASE("glTF materials go by their names, or numbers where they have none") {
  std::string text = write_gltf(triangulated(cube()));
  const std::string primitive = "\"attributes\"";
  const std::size_t at = text.find(primitive);
  REQUIRE(at != std::string::npos);
  const auto with = [&](const std::string& index, const std::string& list) {
    std::string changed = text;
    changed.insert(at, "\"material\":" + index + ",");
    changed.insert(changed.find('{') + 1, "\"materials\":" + list + ",");
    return imported(changed, "mesh.gltf");
  };
  CHECK(with("1", R"([{},{"name":"rubber"}])").materials == std::vector<std::string>{"rubber"});
  CHECK(with("0", R"([{},{"name":"rubber"}])").materials == std::vector<std::string>{"materials[0]"});
  CHECK(with("2", R"([{},{"name":"rubber"}])").materials.empty());  // no such one: as if it had none
  CHECK(with("\"x\"", "7").materials.empty());
  CHECK(with("1", R"([{},{"name":"rubber"}])").face_material == std::vector<std::uint16_t>(12, 0));
}

TEST_CASE("repair and OBJ keep the materials") {
  bake::PolygonSoup soup = imported(kStrip);
  soup.face_first.insert(soup.face_first.begin() + 1, 4);  // a copy of the first face before the others
  soup.corners.insert(soup.corners.begin(), soup.corners.begin(), soup.corners.begin() + 4);
  soup.face_first.back() = static_cast<std::uint32_t>(soup.corners.size());
  soup.face_first = {0, 4, 8, 12};
  soup.face_material = {0, 0, 1};
  soup.face_line.clear();
  bake::RepairOptions options;
  options.drop_duplicate_faces = true;
  const auto repaired = bake::repair(soup, options);
  REQUIRE(repaired);
  CHECK(repaired->soup.face_material == std::vector<std::uint16_t>{0, 1});
  const auto text = bake::export_mesh(repaired->soup, {bake::Format::obj, true});
  REQUIRE(text);
  const bake::PolygonSoup again = imported(*text);
  CHECK(again.materials == soup.materials);
  CHECK(again.face_material == repaired->soup.face_material);
}

TEST_CASE("long and non-UTF-8 names stay distinct in 63 bytes") {
  const std::string stem(60, 'm');
  const bake::PolygonSoup soup =
      imported("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl " + stem + "one\nf 1 3 2\nusemtl " + stem +
               "three\nf 1 2 4\nusemtl " + stem + "four\nf 2 3 4\nusemtl \xff\xfe\nf 1 4 3\n");
  const CompiledMesh mesh(soup);
  REQUIRE(mesh.view().material_count == 4);
  std::map<std::string, int> names;
  for (std::uint32_t i = 0; i < 4; ++i)
    ++names[fdcg_get_material_name(&mesh.view(), i)];
  CHECK(names.size() == 4);
  CHECK_THAT(fdcg_get_material_name(&mesh.view(), 0), Catch::Matchers::Equals(stem + "one"));
  CHECK_THAT(fdcg_get_material_name(&mesh.view(), 1), Catch::Matchers::StartsWith(stem.substr(0, 54) + "~"));
}

TEST_CASE("a file with materials out of range is refused by name") {
  const auto compiled = bake::compile(imported(kStrip), {});
  REQUIRE(compiled);
  struct Damage {
    fdcg_section_id section;
    std::size_t byte;
    unsigned char value;
    const char* message;
  };
  const Damage all[] = {{FDCG_SECTION_MATERIALS, 0, 2, "material out of range"},
                        {FDCG_SECTION_MATERIALS, 3, 0x7F, "material out of range"},
                        {FDCG_SECTION_MATERIAL_NAMES, 0, 0, "name"},
                        {FDCG_SECTION_MATERIAL_NAMES, 63, 'x', "name"}};
  for (const Damage& damage : all) {
    AlignedBytes file(compiled->bytes);
    auto* const sections = reinterpret_cast<fdcg_section*>(file.data() + sizeof(fdcg_header));
    for (std::uint32_t i = 0; i < file.header().section_count; ++i) {
      if (sections[i].id == static_cast<std::uint32_t>(damage.section))
        file.data()[sections[i].offset + damage.byte] = damage.value;
    }
    seal(file);
    fdcg_graph graph;
    fdcg_error error = {};
    CHECK(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_GRAPH);
    CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring(damage.message));
  }
  AlignedBytes file(compiled->bytes);
  auto* const sections = reinterpret_cast<fdcg_section*>(file.data() + sizeof(fdcg_header));
  sections[file.header().section_count - 1].id = 99;  // the names are gone, what was they is skipped
  seal(file);
  fdcg_graph graph;
  fdcg_error error = {};
  CHECK(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_TRUSTED, &graph, &error) == FDCG_E_LAYOUT);
  CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring("go together"));
}
