// SPDX-License-Identifier: Apache-2.0
// Containers, accessors and primitives. Nodes and scenes: import_gltf_scene_test.cpp; refusals: import_gltf_refusal_test.cpp.
#include <cmath>

#include "../../support/gltf_scene.hpp"
#include "../../support/soups.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;

namespace {

using Faces = std::vector<std::vector<std::uint32_t>>;

PolygonSoup float_sphere(std::uint32_t rings = 10, std::uint32_t segments = 12) {
  PolygonSoup soup = bumpy_sphere(rings, segments);
  for (Vec3& p : soup.points)
    p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  return soup;
}

void check_same(const PolygonSoup& soup, const PolygonSoup& mesh) {
  check_invariants(soup);
  CHECK(soup.format == Format::gltf);
  CHECK_FALSE(soup.is_text);
  CHECK(soup.points == mesh.points);
  CHECK(soup.corners == mesh.corners);
  CHECK(soup.face_first == mesh.face_first);
  CHECK(soup.relative_quantum == 0x1p-24);
  CHECK(soup.absolute_quantum == 0);
  CHECK(soup.ignored.empty());
  REQUIRE(soup.parts.size() == 1);
  CHECK(soup.parts[0].name == "node/mesh/primitive 0");
  CHECK(soup.parts[0].first_face == 0);
  CHECK(soup.parts[0].first_point == 0);
}

// The count under a name in `ignored`; 0 where it is not listed.
std::uint64_t ignored(const PolygonSoup& soup, const std::string& what) {
  for (const Ignored& entry : soup.ignored) {
    if (entry.what == what) return entry.count;
  }
  return 0;
}

// One primitive over six points in a row, with the given mode.
GltfScene row(int mode, const std::vector<std::uint32_t>& indices) {
  GltfScene scene;
  const std::size_t positions = scene.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0});
  scene.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", scene.indices(indices)}, {"mode", mode}});
  scene.node({{"mesh", 0}});
  return scene;
}

}  // namespace

TEST_CASE("a mesh comes back from glTF, GLB and GLB with Draco, bit by bit and number by number") {
  const PolygonSoup mesh = float_sphere();
  check_same(import_text(write_gltf(mesh)), mesh);
  check_same(import_text(write_glb(mesh)), mesh);
  check_same(import_text(write_glb_draco(mesh)), mesh);
}

TEST_CASE("glTF is detected by content, also after a byte-order mark, and by extension") {
  const std::string text = square().text();
  CHECK(import_text("\xEF\xBB\xBF" + text).face_count() == 2);
  CHECK(import_text(" \r\n\t" + text).face_count() == 2);
  for (const char* name : {"a.gltf", "a.GLB"}) {
    const Result<PolygonSoup> soup = import_memory("{}", name);
    REQUIRE_FALSE(soup);
    CHECK(soup.error().message == std::string(name) + ": asset is missing; correct the file or export it again");
  }
}

TEST_CASE("indices may have 8, 16 or 32 bits, or be left out") {
  const Faces expected = {{0, 1, 2}, {0, 2, 3}};
  GltfScene scene = square();
  CHECK(faces_of(import_text(scene.text())) == expected);
  Json& primitive = scene.json["meshes"][0]["primitives"][0];
  primitive["indices"] = scene.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, kU8, "SCALAR");
  CHECK(faces_of(import_text(scene.text())) == expected);
  primitive["indices"] = scene.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, kU16, "SCALAR");
  CHECK(faces_of(import_text(scene.glb())) == expected);
  primitive.erase("indices");
  const PolygonSoup soup = import_text(scene.text());
  CHECK(faces_of(soup) == Faces{{0, 1, 2}});
  CHECK(ignored(soup, "corners left over after the last triangle") == 1);
}

TEST_CASE("an index that no vertex has is a defect of the face, in any width") {
  GltfScene scene = square();
  Json& primitive = scene.json["meshes"][0]["primitives"][0];
  primitive["indices"] = scene.accessor<std::uint8_t>({0, 1, 255, 0, 2, 3}, kU8, "SCALAR");
  CHECK(faces_of(import_text(scene.text())) == Faces{{0, 1, kInvalid}, {0, 2, 3}});
  primitive["indices"] = scene.indices({0, 1, 2, 0, 4, 0xFFFFFFFF});
  CHECK(faces_of(import_text(scene.text())) == Faces{{0, 1, 2}, {0, kInvalid, kInvalid}});
}

TEST_CASE("strips and fans are wound as the specification says") {
  CHECK(faces_of(import_text(row(4, {0, 1, 2, 3, 2, 1}).text())) == Faces{{0, 1, 2}, {3, 2, 1}});
  CHECK(faces_of(import_text(row(5, {0, 1, 2, 3, 4}).text())) == Faces{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}});
  CHECK(faces_of(import_text(row(6, {0, 1, 2, 3, 4}).text())) == Faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
}

TEST_CASE("joints of strips are counted and not faces; a face with an index out of range is kept") {
  const PolygonSoup soup = import_text(row(5, {0, 1, 2, 2, 3, 3, 4, 5}).text());
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {3, 5, 4}});  // between them 1 2 2, 2 2 3, 2 3 3 and 3 3 4
  CHECK(ignored(soup, "strip joints") == 4);
  const PolygonSoup bad = import_text(row(5, {0, 1, 9, 9, 1}).text());
  CHECK(faces_of(bad) == Faces{{0, 1, kInvalid}, {1, kInvalid, kInvalid}, {kInvalid, kInvalid, 1}});
  CHECK(bad.ignored.empty());
  GltfScene with_short = row(4, {0, 1, 2});
  Json strip = with_short.json["meshes"][0]["primitives"][0];
  strip["mode"] = 5;
  strip["indices"] = with_short.indices({0, 1});
  with_short.json["meshes"][0]["primitives"].push_back(strip);
  CHECK(ignored(import_text(with_short.text()), "strips of fewer than three vertices") == 1);
}

TEST_CASE("points and lines are counted, not faces") {
  GltfScene scene = row(4, {0, 1, 2});
  for (const int mode : {0, 1, 2, 3}) {
    Json primitive = scene.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    primitive["indices"] = scene.indices({0, 1, 2, 3, 4, 5});
    scene.json["meshes"][0]["primitives"].push_back(primitive);
  }
  const PolygonSoup soup = import_text(scene.text());
  CHECK(soup.face_count() == 1);
  CHECK(soup.points.size() == 6);
  CHECK(ignored(soup, "points") == 6);
  CHECK(ignored(soup, "line elements") == 3 + 6 + 5);
  REQUIRE(soup.parts.size() == 1);
  CHECK(soup.parts[0].name == "nodes[0]/meshes[0]/primitive 0");
}

TEST_CASE("accessor values may have a stride, an offset, or be interleaved") {
  GltfScene scene;
  std::string bytes = "head";
  for (const float x : {1.0f, 2.0f, 3.0f}) {
    for (const float c : {x, x * x, -x})
      put<float>(bytes, c);
    bytes += "normal, colour, ";  // 16 bytes of others
  }
  const std::size_t view = scene.view(bytes, 28);
  scene.json["accessors"] = {
      {{"bufferView", view}, {"byteOffset", 4}, {"componentType", kF32}, {"type", "VEC3"}, {"count", 3}}};
  scene.mesh({{"attributes", {{"POSITION", 0}}}});
  scene.node({{"mesh", 0}});
  const PolygonSoup soup = import_text(scene.text());
  CHECK(soup.points == std::vector<Vec3>{{1, 1, -1}, {2, 4, -2}, {3, 9, -3}});
  // The last value needs no whole stride behind it.
  scene.json["bufferViews"][view]["byteLength"] = 4 + 2 * 28 + 12;
  CHECK(import_text(scene.text()).points == soup.points);
  scene.json["bufferViews"][view]["byteLength"] = 4 + 2 * 28 + 11;
  CHECK(refusal(scene.text()).find("accessors[0] promises 3 values of 12 bytes, bufferViews[0] holds 2") != std::string::npos);
}

TEST_CASE("sparse accessors replace values, of zeros too") {
  GltfScene scene = square();
  const std::size_t places = scene.view(std::string("\1\0\3\0", 4));
  std::string values;
  for (const float c : {5.f, 6.f, 7.f, 8.f, 9.f, 10.f})
    put<float>(values, c);
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", places}, {"componentType", kU16}}},
                       {"values", {{"bufferView", scene.view(values)}}}};
  scene.json["accessors"][0]["sparse"] = sparse;
  CHECK(import_text(scene.text()).points == std::vector<Vec3>{{0, 0, 0}, {5, 6, 7}, {1, 1, 0}, {8, 9, 10}});
  scene.json["accessors"][0].erase("bufferView");
  CHECK(import_text(scene.text()).points == std::vector<Vec3>{{0, 0, 0}, {5, 6, 7}, {0, 0, 0}, {8, 9, 10}});

  GltfScene indexed = square();
  const std::size_t at = indexed.view(std::string("\2\5", 2));
  std::string numbers;
  put<std::uint32_t>(numbers, 3);
  put<std::uint32_t>(numbers, 1);
  indexed.json["accessors"][1]["sparse"] = {{"count", 2},
                                            {"indices", {{"bufferView", at}, {"componentType", kU8}}},
                                            {"values", {{"bufferView", indexed.view(numbers)}}}};
  CHECK(faces_of(import_text(indexed.text())) == Faces{{0, 1, 3}, {0, 2, 1}});
}

TEST_CASE("positions may be integers, normalised or not, and give their quantum") {
  GltfScene scene = square_mesh();
  Json& primitive = scene.json["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  scene.node({{"mesh", 0}});
  const auto with = [&](std::size_t accessor, bool is_normalized) {
    scene.json["accessors"][accessor]["normalized"] = is_normalized;
    scene.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
    return import_text(scene.text());
  };
  const std::size_t i8 = scene.accessor<std::int8_t>({-128, -127, 127, 0, 1, 2, 3, 4, 5}, kI8, "VEC3");
  CHECK(with(i8, false).points[0] == Vec3{-128, -127, 127});
  CHECK(with(i8, true).points[0] == Vec3{-1, -1, 1});
  CHECK(with(i8, true).points[1] == Vec3{0, 1.0 / 127, 2.0 / 127});
  const std::size_t u8 = scene.accessor<std::uint8_t>({0, 255, 128, 0, 1, 2, 3, 4, 5}, kU8, "VEC3");
  CHECK(with(u8, false).points[0] == Vec3{0, 255, 128});
  CHECK(with(u8, true).points[0] == Vec3{0, 1, 128.0 / 255});
  const std::size_t i16 = scene.accessor<std::int16_t>({-32768, 32767, -1, 0, 1, 2, 3, 4, 5}, kI16, "VEC3");
  CHECK(with(i16, false).points[0] == Vec3{-32768, 32767, -1});
  CHECK(with(i16, true).points[0] == Vec3{-1, 1, -1.0 / 32767});
  const std::size_t u16 = scene.accessor<std::uint16_t>({0, 65535, 256, 0, 1, 2, 3, 4, 5}, kU16, "VEC3");
  CHECK(with(u16, false).points[0] == Vec3{0, 65535, 256});
  const PolygonSoup soup = with(u16, true);
  CHECK(soup.points[0] == Vec3{0, 1, 256.0 / 65535});
  CHECK(soup.relative_quantum == 0x1p-53);
  CHECK(soup.absolute_quantum == 0.5 / 65535);
  CHECK(with(u8, false).absolute_quantum == 0);  // a grid, drawn on
}

TEST_CASE("primitives of a mesh are parts with names; those on the same accessor share its points") {
  GltfScene scene = square();
  scene.json["nodes"][0]["name"] = "door";
  scene.json["meshes"][0]["name"] = "panel";
  Json shared = scene.json["meshes"][0]["primitives"][0];
  shared["indices"] = scene.indices({3, 2, 1});
  Json own = shared;
  own["attributes"]["POSITION"] = scene.positions({0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1});
  scene.json["meshes"][0]["primitives"].push_back(shared);
  scene.json["meshes"][0]["primitives"].push_back({{"attributes", Json::object()}});
  scene.json["meshes"][0]["primitives"].push_back(own);
  const PolygonSoup soup = import_text(scene.text());
  CHECK(soup.points.size() == 8);
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}, {7, 6, 5}});
  CHECK(ignored(soup, "primitives without positions") == 1);
  REQUIRE(soup.parts.size() == 3);
  CHECK(soup.parts[0].name == "door/panel/primitive 0");
  CHECK(soup.parts[1].name == "door/panel/primitive 1");
  CHECK(soup.parts[2].name == "door/panel/primitive 3");
  CHECK(soup.parts[1].first_face == 2);
  CHECK(soup.parts[1].first_point == 0);
  CHECK(soup.parts[2].first_face == 3);
  CHECK(soup.parts[2].first_point == 4);
}

TEST_CASE("long names of parts are cut between characters") {
  GltfScene scene = square();
  std::string name = "a";
  for (int i = 0; i < 100; ++i)
    name += "\xC3\xA4";  // two bytes each
  scene.json["nodes"][0]["name"] = name;
  CHECK(import_text(scene.text()).parts[0].name == name.substr(0, 127) + "/meshes[0]/primitive 0");
}

TEST_CASE("Draco-compressed primitives are decoded by the unique id that they name, and keep their quantum") {
  const PolygonSoup mesh = float_sphere();
  const PolygonSoup exact = import_text(write_glb_draco(mesh, {DracoMethod::edgebreaker, 0}));
  CHECK(exact.face_count() == mesh.face_count());
  CHECK(exact.absolute_quantum == 0);
  const PolygonSoup coarse = import_text(write_glb_draco(mesh, {DracoMethod::edgebreaker, 12}));
  CHECK(coarse.relative_quantum == 0x1p-24);
  CHECK(coarse.absolute_quantum == Approx(2.0 / 4095 / 2).epsilon(0.2));

  GltfScene scene;
  const std::size_t view = scene.view(write_drc(mesh)), other = scene.view(write_drc(bumpy_sphere(4, 5)));
  scene.json["accessors"] = {{{"componentType", kF32}, {"type", "VEC3"}, {"count", mesh.points.size()}},
                             {{"componentType", kU16}, {"type", "SCALAR"}, {"count", mesh.corners.size() + 6}}};
  const auto primitive = [](std::size_t bufferView, int id) {
    return Json{
        {"attributes", {{"POSITION", 0}}},
        {"indices", 1},
        {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", bufferView}, {"attributes", {{"POSITION", id}}}}}}}};
  };
  scene.mesh(primitive(view, 0));
  scene.json["meshes"][0]["primitives"].push_back(primitive(other, 0));
  scene.node({{"mesh", 0}});
  const PolygonSoup soup = import_text(scene.glb());
  CHECK(soup.face_count() == mesh.face_count() + bumpy_sphere(4, 5).face_count());
  REQUIRE(soup.parts.size() == 2);
  CHECK(soup.parts[1].first_face == mesh.face_count());
  CHECK(soup.parts[1].first_point == mesh.points.size());
  CHECK(ignored(soup, "faces promised beyond the Draco data") == 2 + (mesh.face_count() + 2 - bumpy_sphere(4, 5).face_count()));
  scene.json["meshes"][0]["primitives"][1] = primitive(view, 7);
  CHECK(refusal(scene.glb()) ==
        "mesh: meshes[0].primitives[1]: its Draco data has no attribute with the unique id 7 for its positions; fetch the file "
        "or compress the mesh again");
}
