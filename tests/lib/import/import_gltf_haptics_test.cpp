// SPDX-License-Identifier: Apache-2.0
// MPEG_haptic_material of glTF: what its textures hold over the faces, the names of these, and what is refused.
#include <string>
#include <vector>

#include "gltf_writer.hpp"
#include "import_support.hpp"
#include "png_writer.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

// Left half black, right half white.
std::string halves_png() {
  std::vector<std::uint16_t> values;
  for (int i = 0; i < 8 * 4; ++i)
    values.push_back(i % 8 < 4 ? 0 : 255);
  return png_bytes(8, 4, 1, 8, values);
}

// Two meshes, a rectangle each: one over the whole image and one, three times as large, over its right half.
struct Sheets {
  std::string textures =
      R"({"name":"rubber","stiffness":[{"type":"Low_Resolution","texture":{"index":1}},)"
      R"({"type":"High_Resolution","texture":{"index":0}}],)"
      R"("friction":[{"type":"Reference","texture":{"index":9}},{"type":"Low_Resolution","texture":{"index":1}}]},)"
      R"({"vibration":[{"type":"Other","texture":{"index":0}}]})";
  std::string first = R"(,"extensions":{"MPEG_haptic_material":{"hapticMaterialIndex":0}})", second = first, more = {};

  [[nodiscard]] std::string gltf() const {
    std::string bytes;
    for (const float c : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f,  // positions
                          2.f, 0.f, 0.f, 5.f, 0.f, 0.f, 5.f, 1.f, 0.f, 2.f, 1.f, 0.f,  //
                          0.f, 1.f, 1.f, 1.f, 1.f, 0.f, 0.f, 0.f,                      // texture coordinates
                          .5f, 1.f, 1.f, 1.f, 1.f, 0.f, .5f, 0.f})
      put(bytes, c);
    for (const std::uint16_t i : {0, 1, 2, 0, 2, 3})
      put(bytes, i);
    const std::string grey = png_bytes(1, 1, 3, 8, {51, 51, 51});
    const auto image = [](const std::string& png) { return R"({"uri":"data:image/png;base64,)" + base64(png) + "\"}"; };
    const auto accessor = [](int offset, const char* type, int component, int count) {
      return R"({"bufferView":0,"byteOffset":)" + std::to_string(offset) + R"(,"componentType":)" + std::to_string(component) +
             R"(,"count":)" + std::to_string(count) + R"(,"type":")" + type + "\"}";
    };
    return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0},{"mesh":1}],"meshes":[)"
           R"({"primitives":[{"material":0,"indices":4,"attributes":{"POSITION":0,"TEXCOORD_0":2}}])" +
           first + R"(},{"primitives":[{"material":0,"indices":4,"attributes":{"POSITION":1,"TEXCOORD_0":3}}])" + second +
           R"(}],"materials":[{"name":"seen"}],"textures":[{"source":0},{"source":1}],"images":[)" + image(halves_png()) + "," +
           image(grey) +
           R"(],"extensionsRequired":["MPEG_haptic_material"],"extensions":{"MPEG_haptic_material":{"materials":[)" + textures +
           "]}" + more + R"(},"accessors":[)" + accessor(0, "VEC3", 5126, 4) + "," + accessor(48, "VEC3", 5126, 4) + "," +
           accessor(96, "VEC2", 5126, 4) + "," + accessor(128, "VEC2", 5126, 4) + "," + accessor(160, "SCALAR", 5123, 6) +
           R"(],"bufferViews":[{"buffer":0,"byteLength":172}],)"
           R"("buffers":[{"byteLength":172,"uri":"data:;base64,)" +
           base64(bytes) + R"("}]})";
  }
};

ImportOptions asking() {
  ImportOptions options;
  options.haptic_materials = true;
  return options;
}

PolygonSoup imported(const Sheets& sheets, const ImportOptions& options = asking()) {
  auto soup = import_memory(sheets.gltf(), "sheets.gltf", options);
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup);
  return *soup;
}

}  // namespace

TEST_CASE("textures of stiffness and friction are listed as what they hold over the faces, by area") {
  const PolygonSoup soup = imported({});
  REQUIRE(soup.physics.haptic_materials.size() == 2);
  const HapticMaterial& rubber = soup.physics.haptic_materials[0];
  CHECK(rubber.name == "rubber");
  REQUIRE(rubber.stiffness);
  CHECK(rubber.stiffness->mean == Approx((1 * 0.5 + 3 * 1.0) / 4).margin(0.01));  // of 1 and 3 square units
  CHECK(rubber.stiffness->least == 0);
  CHECK(rubber.stiffness->most == 1);
  REQUIRE(rubber.friction);
  CHECK(rubber.friction->mean == Approx(0.2));
  CHECK(rubber.friction->least == Approx(rubber.friction->most));
  const HapticMaterial& other = soup.physics.haptic_materials[1];
  CHECK(other.name == "haptic materials[1]");
  CHECK_FALSE(other.stiffness);
  CHECK_FALSE(other.friction);
}

TEST_CASE("faces have the names of their haptic materials, and none unless they are asked for") {
  Sheets sheets;
  sheets.second = "";
  const PolygonSoup soup = imported(sheets);
  CHECK(soup.materials == std::vector<std::string>{"rubber", "seen"});
  CHECK(soup.face_material == std::vector<std::uint16_t>{0, 0, 1, 1});
  CHECK(soup.physics.haptic_materials[0].stiffness->mean == Approx(0.5).margin(0.05));
  const PolygonSoup plain = imported(sheets, {});
  CHECK(plain.materials == std::vector<std::string>{"seen"});
  CHECK(plain.physics.is_empty());
}

TEST_CASE("a haptic material that no face has, or without texture coordinates, has no values") {
  Sheets sheets;
  sheets.first = sheets.second = "";
  CHECK_FALSE(imported(sheets).physics.haptic_materials[0].stiffness);
  sheets.textures = R"({"stiffness":[]})";
  CHECK_FALSE(imported(sheets).physics.haptic_materials[0].stiffness);
}

TEST_CASE("what is wrong with haptic materials is said, where they are asked for") {
  const auto said = [](const Sheets& sheets) {
    CHECK(import_memory(sheets.gltf(), "sheets.gltf"));
    const auto soup = import_memory(sheets.gltf(), "sheets.gltf", asking());
    REQUIRE_FALSE(soup);
    CHECK(soup.error().exit_code == 3);
    CHECK(soup.error().message.find('\n') == std::string::npos);
    return soup.error().message;
  };
  Sheets sheets;
  sheets.second = R"(,"extensions":{"MPEG_haptic_material":{"hapticMaterialIndex":2}})";
  CHECK_THAT(said(sheets), ContainsSubstring("hapticMaterialIndex is 2, but the file has 2 haptic materials"));
  sheets.second = R"(,"extensions":{"MPEG_haptic_material":{}})";
  CHECK_THAT(said(sheets), ContainsSubstring("hapticMaterialIndex is missing"));
  const auto with = [&](const std::string& textures) {
    Sheets changed;
    changed.second = "";
    changed.textures = textures;
    return said(changed);
  };
  CHECK_THAT(with(R"({"stiffness":[{"type":"Fine","texture":{"index":0}}]})"),
             ContainsSubstring("stiffness[0].type is \"Fine\""));
  CHECK_THAT(with(R"({"stiffness":[{"texture":{"index":0}}]})"), ContainsSubstring("stiffness[0].type is missing"));
  CHECK_THAT(with(R"({"stiffness":[{"type":"High_Resolution"}]})"), ContainsSubstring("texture"));
  CHECK_THAT(with(R"({"friction":[{"type":"High_Resolution","texture":{"index":7}}]})"),
             ContainsSubstring("friction[0].texture.index is 7, but the file has 2 textures"));
  CHECK_THAT(with(R"({"friction":[{"type":"High_Resolution","texture":{"index":0,"texCoord":1}}]})"),
             ContainsSubstring("another set of texture coordinates"));
  CHECK_THAT(with(R"({"name":7})"), ContainsSubstring("materials[0].name"));
}
