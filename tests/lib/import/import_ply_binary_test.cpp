// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <functional>
#include <random>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {
using Faces = std::vector<std::vector<std::uint32_t>>;

std::string header(bool is_big_endian, const std::string& elements) {
  return std::string("ply\nformat binary_") + (is_big_endian ? "big" : "little") + "_endian 1.0\n" + elements + "end_header\n";
}
std::string vertex_element(std::size_t count, const std::string& type = "float") {
  return "element vertex " + std::to_string(count) + "\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
         " z\n";
}
std::string face_element(std::size_t count, const std::string& types = "uchar int") {
  return "element face " + std::to_string(count) + "\nproperty list " + types + " vertex_indices\n";
}

// Appends a number as the named PLY type.
void put_as(std::string& bytes, const std::string& type, double value, bool big) {
  if (type == "char" || type == "int8") put(bytes, static_cast<std::int8_t>(value), big);
  if (type == "uchar" || type == "uint8") put(bytes, static_cast<std::uint8_t>(value), big);
  if (type == "short" || type == "int16") put(bytes, static_cast<std::int16_t>(value), big);
  if (type == "ushort" || type == "uint16") put(bytes, static_cast<std::uint16_t>(value), big);
  if (type == "int" || type == "int32") put(bytes, static_cast<std::int32_t>(value), big);
  if (type == "uint" || type == "uint32") put(bytes, static_cast<std::uint32_t>(value), big);
  if (type == "float" || type == "float32") put(bytes, static_cast<float>(value), big);
  if (type == "double" || type == "float64") put(bytes, value, big);
}
const std::vector<std::string> kTypes = {"char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
                                         "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};
}  // namespace

TEST_CASE("PLY binary: coordinates, counts and indices may have any scalar type and either byte order") {
  for (const bool big : {false, true}) {
    for (const std::string& type : kTypes) {
      INFO(type << (big ? ", big endian" : ", little endian"));
      std::string bytes = header(big, vertex_element(4, type) + face_element(2, type + " " + type));
      for (int i = 0; i < 12; ++i)
        put_as(bytes, type, i * 7, big);
      for (const int n : {3, 0, 1, 2, 4, 3, 2, 1, 0})
        put_as(bytes, type, n, big);
      const PolygonSoup soup = import_text(bytes);
      check_invariants(soup);
      CHECK(soup.points == std::vector<Vec3>{{0, 7, 14}, {21, 28, 35}, {42, 49, 56}, {63, 70, 77}});
      CHECK(faces_of(soup) == Faces{{0, 1, 2}, {3, 2, 1, 0}});
      CHECK(soup.absolute_quantum == 0);
      CHECK(soup.relative_quantum == 0x1p-24);
    }
  }
}

TEST_CASE("PLY binary: x, y and z may differ in type and stand among other properties in any order") {
  std::string bytes =
      header(true,
             "element vertex 2\nproperty short z\nproperty uchar red\nproperty double x\nproperty float y\n"
             "element face 1\nproperty float quality\nproperty list ushort uchar vertex_index\nproperty int flags\n");
  for (int i = 0; i < 2; ++i) {
    put<std::int16_t>(bytes, static_cast<std::int16_t>(-300 - i), true);
    put<std::uint8_t>(bytes, 255, true);
    put<double>(bytes, 0.1 + i, true);
    put<float>(bytes, 0.5F, true);
  }
  put<float>(bytes, 1.0F, true);
  put<std::uint16_t>(bytes, 3, true);
  for (const std::uint8_t c : {0, 1, 200})
    put(bytes, c, true);
  put<std::int32_t>(bytes, -1, true);
  const PolygonSoup soup = import_text(bytes);
  check_invariants(soup);
  CHECK(soup.points == std::vector<Vec3>{{0.1, 0.5, -300}, {1.1, 0.5, -301}});
  CHECK(faces_of(soup) == Faces{{0, 1, kInvalid}});
  CHECK(soup.relative_quantum == 0x1p-53);
}

TEST_CASE("PLY binary: lists in a vertex and elements with lists around the geometry are skipped") {
  std::string bytes =
      header(false,
             "element camera 1\nproperty list uchar double steps\nelement vertex 3\nproperty list uchar short ids\n"
             "property float x\nproperty float y\nproperty float z\nelement edge 2\nproperty int a\n" +
                 face_element(1) + "property list uchar float texcoord\nelement tail 1\nproperty list int char name\n");
  put<std::uint8_t>(bytes, 2);
  put<double>(bytes, 1);
  put<double>(bytes, 2);
  for (int i = 0; i < 3; ++i) {
    put(bytes, static_cast<std::uint8_t>(i));
    for (int k = 0; k < i; ++k)
      put<std::int16_t>(bytes, 9);
    for (int k = 0; k < 3; ++k)
      put(bytes, static_cast<float>(10 * i + k));
  }
  put<std::int32_t>(bytes, 1);
  put<std::int32_t>(bytes, 2);
  put<std::uint8_t>(bytes, 3);
  for (const std::int32_t c : {2, 1, 0})
    put(bytes, c);
  put<std::uint8_t>(bytes, 1);
  put<float>(bytes, 0.5F);
  put<std::int32_t>(bytes, 4);
  bytes += "name";
  const PolygonSoup soup = import_text(bytes);
  check_invariants(soup);
  CHECK(soup.points == std::vector<Vec3>{{0, 1, 2}, {10, 11, 12}, {20, 21, 22}});
  CHECK(faces_of(soup) == Faces{{2, 1, 0}});
}

TEST_CASE("PLY binary: large meshes are read right with any mixture of polygons and types") {
  // Long enough for the block-wise loops, with polygons that interrupt them now and then.
  std::mt19937 random(2);
  for (const std::string types : {"uchar int", "char uint", "int int", "uint uint", "short int", "uchar ushort"}) {
    for (const int other_every : {0, 1, 3, 700, 5'000}) {
      const bool big = random() % 2 == 0, has_extra = random() % 2 == 0;
      const std::size_t vertex_count = 3'001, face_count = 6'007;
      INFO(types << ", another polygon every " << other_every << ", big endian " << big);
      std::string bytes = header(big, vertex_element(vertex_count) + "element face " + std::to_string(face_count) +
                                          (has_extra ? "\nproperty short before" : "") + "\nproperty list " + types +
                                          " vertex_indices\n" + (has_extra ? "property uchar after\n" : ""));
      std::vector<Vec3> points(vertex_count);
      for (Vec3& p : points) {
        for (double* c : {&p.x, &p.y, &p.z}) {
          *c = static_cast<float>(random()) * 1e-9F;
          put(bytes, static_cast<float>(*c), big);
        }
      }
      Faces faces(face_count);
      const std::string count_type = types.substr(0, types.find(' ')), index_type = types.substr(types.find(' ') + 1);
      for (std::size_t f = 0; f < face_count; ++f) {
        const bool is_other =
            other_every > 0 && f % static_cast<std::size_t>(other_every) == static_cast<std::size_t>(other_every) - 1;
        const std::size_t n = is_other ? 1 + random() % 7 : 3;
        if (has_extra) put<std::int16_t>(bytes, 3, big);
        put_as(bytes, count_type, static_cast<double>(n), big);
        for (std::size_t k = 0; k < n; ++k) {
          const std::uint32_t index = random() % (vertex_count + 20);
          put_as(bytes, index_type, index, big);
          faces[f].push_back(index < vertex_count ? index : kInvalid);
        }
        if (has_extra) put<std::uint8_t>(bytes, 9, big);
      }
      const PolygonSoup soup = import_text(bytes);
      check_invariants(soup);
      CHECK(soup.points == points);
      CHECK(faces_of(soup) == faces);
    }
  }
}

TEST_CASE("PLY binary: negative and far numbers are invalid in the fast loop too") {
  for (const std::string type : {"int", "uint"}) {
    std::string bytes = header(false, vertex_element(3) + face_element(600, "uchar " + type));
    for (int i = 0; i < 9; ++i)
      put(bytes, static_cast<float>(i));
    for (int f = 0; f < 600; ++f) {
      put<std::uint8_t>(bytes, 3);
      for (const std::uint32_t c : {2u, 3u, f % 2 == 0 ? 0xFFFFFFFFu : 0x80000000u})
        put(bytes, c);
    }
    CHECK(faces_of(import_text(bytes)) == Faces(600, {2, kInvalid, kInvalid}));
  }
}

TEST_CASE("PLY binary: doubles keep every bit, NaN and infinities included") {
  std::mt19937_64 random(3);
  for (const bool big : {false, true}) {
    std::string bytes = header(big, vertex_element(1'000, "double") + face_element(1));
    std::vector<std::uint64_t> bits(3'000);
    for (std::uint64_t& b : bits) {
      b = random();
      put(bytes, b, big);
    }
    put<std::uint8_t>(bytes, 3, big);
    for (const std::int32_t c : {0, 1, 2})
      put(bytes, c, big);
    const PolygonSoup soup = import_text(bytes);
    bool is_same = true;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      const Vec3& p = soup.points[i / 3];
      const double c = i % 3 == 0 ? p.x : i % 3 == 1 ? p.y : p.z;
      is_same = is_same && std::bit_cast<std::uint64_t>(c) == bits[i];
    }
    CHECK(is_same);
  }
}

TEST_CASE("PLY binary: triangle strips restart at -1 of any type") {
  for (const std::string type : {"int", "short", "char", "uint", "float"}) {
    std::string bytes =
        header(false, vertex_element(5) + "element tristrips 1\nproperty list int " + type + " vertex_indices\n");
    for (int i = 0; i < 15; ++i)
      put(bytes, static_cast<float>(i));
    put<std::int32_t>(bytes, 9);
    for (const double c : {0., 1., 2., 3., -1., 4., 3., 2., 7.}) {
      put_as(bytes, type, type == "uint" && c == -1 ? 4294967295. : c, false);
    }
    CHECK(faces_of(import_text(bytes)) == Faces{{0, 1, 2}, {2, 1, 3}, {4, 3, 2}, {2, 3, kInvalid}});
  }
}

TEST_CASE("PLY binary: the body starts right behind the header's last line, whatever its first byte") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string bytes;
    for (const char c : header(false, vertex_element(3, "uchar") + face_element(1, "uchar uchar"))) {
      bytes += c == '\n' ? end : std::string(1, c);
    }
    for (const std::uint8_t b : {10, 13, 32, 4, 5, 6, 7, 8, 10, 3, 0, 1, 2})
      put(bytes, b);
    CHECK(import_text(bytes).points == std::vector<Vec3>{{10, 13, 32}, {4, 5, 6}, {7, 8, 10}});
  }
}

TEST_CASE("PLY binary: a refusal names the byte, what was expected and what was found") {
  const std::string start = header(false, vertex_element(1, "uchar") + face_element(2, "char uchar"));
  const std::string at = "byte " + std::to_string(start.size());
  CHECK(refusal(start + "ab")
            .find("truncated: " + at + ": the header promises 1 rows of element 'vertex' of 3 bytes, the 2 bytes left") !=
        std::string::npos);
  CHECK(refusal(start + std::string("abc\3\0\0\0\3\0", 9))
            .find("row 1 of 2 of element 'face' needs 3 more bytes, the file has 1") != std::string::npos);
  CHECK(refusal(start + std::string("abc\xFF\0\0", 6)).find("a list with the count -1") != std::string::npos);
  CHECK(refusal(start + std::string("abc\1\0\1\0zz", 9)).find("2 bytes follow the last row") != std::string::npos);
  CHECK(import_text(start + std::string("abc\1\0\1\0\n\0\0", 10)).face_count() == 2);  // padding

  std::string fraction = header(false, vertex_element(1, "uchar") + face_element(1, "float uchar")) + "abc";
  put(fraction, 1.5F);
  CHECK(refusal(fraction + "a").find("not a whole number") != std::string::npos);
  std::string nan = header(false, vertex_element(1, "uchar") + face_element(1, "float uchar")) + "abc";
  put(nan, std::nanf(""));
  CHECK(refusal(nan + "a").find("not a whole number") != std::string::npos);
}

TEST_CASE("PLY binary: a face of more corners than the limit is refused, one at the limit is kept") {
  const auto file = [](std::uint32_t corners) {
    std::string bytes = header(false, vertex_element(1, "uchar") + face_element(1, "uint uchar")) + "abc";
    put(bytes, corners);
    return bytes + std::string(corners, '\0');
  };
  CHECK(import_text(file(65'536)).corners.size() == 65'536);
  CHECK(refusal(file(65'537)) == "mesh: face 0 has 65537 corners; the limit is 65536: cut it into smaller polygons");
}
