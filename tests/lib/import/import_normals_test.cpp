// SPDX-License-Identifier: Apache-2.0
// Normals at corners, as mesh files have them, for force shading. OBJ's are tested in graph/corner_normals_test.cpp.
#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "gltf_writer.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

template <class T>
void put(std::string& bytes, T value, bool is_big = false) {
  std::string own(sizeof value, '\0');
  std::memcpy(own.data(), &value, sizeof value);
  if (is_big) std::reverse(own.begin(), own.end());
  bytes += own;
}

ImportOptions wanting_normals() {
  ImportOptions import;
  import.normals = true;
  return import;
}

}  // namespace

TEST_CASE("a PLY file's own normals are taken, in text and in binary") {
  const std::string rows =
      "element vertex 4\nproperty float x\nproperty float nz\nproperty float y\nproperty double nx\n"
      "property float z\nproperty short ny\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const double points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double normals[4][3] = {{-1, -1, -1}, {1, 0, 0.5}, {0.25, 2, 0}, {0, 0, 3}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  std::string text = "ply\nformat ascii 1.0\n" + rows;
  std::string little = "ply\nformat binary_little_endian 1.0\n" + rows, big = "ply\nformat binary_big_endian 1.0\n" + rows;
  for (int v = 0; v < 4; ++v) {
    std::ostringstream line;
    line << points[v][0] << ' ' << normals[v][2] << ' ' << points[v][1] << ' ' << normals[v][0] << ' ' << points[v][2] << ' '
         << normals[v][1] << '\n';
    text += line.str();
    for (std::string* const bytes : {&little, &big}) {
      const bool is_big = bytes == &big;
      put(*bytes, static_cast<float>(points[v][0]), is_big), put(*bytes, static_cast<float>(normals[v][2]), is_big);
      put(*bytes, static_cast<float>(points[v][1]), is_big), put(*bytes, normals[v][0], is_big);
      put(*bytes, static_cast<float>(points[v][2]), is_big), put(*bytes, static_cast<std::int16_t>(normals[v][1]), is_big);
    }
  }
  for (const auto& face : faces) {
    std::ostringstream line;
    line << "3 " << face[0] << ' ' << face[1] << ' ' << face[2] << '\n';
    text += line.str();
    for (std::string* const bytes : {&little, &big}) {
      put(*bytes, std::uint8_t{3});
      for (const int corner : face)
        put(*bytes, corner, bytes == &big);
    }
  }
  for (const std::string& file : {text, little, big}) {
    const auto soup = import_memory(file, "four.ply", wanting_normals());
    REQUIRE(soup);
    REQUIRE(soup->corner_normals.size() == 12);
    for (std::size_t i = 0; i < 12; ++i) {
      const double* const n = normals[faces[i / 3][i % 3]];
      CHECK(soup->corner_normals[i] == Vec3{n[0], n[1], n[2]});
    }
    CHECK(soup->points[1] == Vec3{1, 0, 0});
    CHECK(import_memory(file, "four.ply")->corner_normals.empty());
  }
  // without one of the three there are none, and what looks like them is passed by
  std::string fewer = text;
  fewer.replace(fewer.find("short ny"), 8, "short my");
  CHECK(import_memory(fewer, "four.ply", wanting_normals())->corner_normals.empty());
}

TEST_CASE("a glTF file's own normals are taken, and turned with their nodes") {
  const float points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const float normals[4][3] = {{-1, -1, -1}, {1, 0, 0.5F}, {0, 1, 0}, {0, 0, 1}};
  const std::uint16_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  std::string bytes;
  for (const auto* const values : {points, normals})
    for (int v = 0; v < 4; ++v)
      for (int k = 0; k < 3; ++k)
        put(bytes, values[v][k]);
  for (const std::uint16_t corner : faces)
    put(bytes, corner);
  const auto file = [&bytes](const char* node, const char* count) {
    return std::string(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0)") + node +
           R"(}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                           {"bufferView": 1, "componentType": 5126, "count": )" +
           count + R"(, "type": "VEC3"},
                           {"bufferView": 2, "componentType": 5123, "count": 12, "type": "SCALAR"}],
             "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48},
                             {"buffer": 0, "byteOffset": 96, "byteLength": 24}],
             "buffers": [{"byteLength": 120, "uri": "data:application/octet-stream;base64,)" +
           base64(bytes) + R"("}]})";
  };
  const auto soup = import_memory(file("", "4"), "four.gltf", wanting_normals());
  REQUIRE(soup);
  REQUIRE(soup->corner_normals.size() == 12);
  CHECK(soup->corner_normals[0] == Vec3{-1, -1, -1});
  CHECK(soup->corner_normals[2] == Vec3{1, 0, 0.5});
  CHECK(import_memory(file("", "4"), "four.gltf")->corner_normals.empty());
  // twice as long along x: a normal leans less along it. (1, 0, 0.5) goes as (0.5, 0, 0.5)
  const auto scaled_soup = import_memory(file(R"(, "scale": [2, 1, 1])", "4"), "four.gltf", wanting_normals());
  REQUIRE(scaled_soup);
  const Vec3 leaning = scaled_soup->corner_normals[2];
  CHECK(leaning.x == leaning.z);
  CHECK(leaning.x > 0);
  // mirrored: faces are wound the other way, normals still point outward
  const auto mirrored = import_memory(file(R"(, "scale": [-1, 1, 1])", "4"), "four.gltf", wanting_normals());
  REQUIRE(mirrored);
  for (std::size_t i = 0; i < 12; ++i) {
    const Vec3 n = mirrored->corner_normals[i], p = mirrored->points[mirrored->corners[i]];
    if (p == Vec3{-1, 0, 0}) CHECK(n == Vec3{-1, 0, 0.5});
    if (p == Vec3{0, 0, 0}) CHECK(n == Vec3{1, -1, -1});
  }
  const auto too_few = import_memory(file("", "3"), "four.gltf", wanting_normals());
  REQUIRE(too_few);
  CHECK(too_few->corner_normals.empty());
  CHECK(too_few->ignored.size() == 1);
}
