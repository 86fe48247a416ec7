// SPDX-License-Identifier: Apache-2.0
// A separate program, because it replaces operator new: import allocates no more memory than the file's bytes can fill.
#include <cstdlib>
#include <new>

#include "../../support/import_support.hpp"

namespace {
std::size_t requested = 0;  // by all calls since the last reset
}

void* operator new(std::size_t size) {
  requested += size;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  requested += size;
  return std::malloc(size == 0 ? 1 : size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}

using namespace fdcg::bake;
using namespace fdcg::bake::test;

TEST_CASE("counts of four billion in a small file allocate no memory") {
  const std::string vertices = "property float x\nproperty float y\nproperty float z\n",
                    list = "property list uchar int vertex_indices\n";
  std::string stl(80, ' ');
  put<std::uint32_t>(stl, 4'294'967'295);
  stl.resize(300, '\0');
  std::vector<std::string> files = {"OFF\n4000000000 1 0\n0 0 0\n",
                                    "OFF\n1 4000000000 0\n0 0 0\n3 0 0 0\n",
                                    "OFF\n1 9000000000000000000 0\n0 0 0\n4000000000 0 0 0\n",
                                    "ply\nformat ascii 1.0\nelement vertex 4000000000\n" + vertices + "end_header\n0 0 0\n",
                                    "ply\nformat ascii 1.0\nelement vertex 1\n" + vertices + "element face 4000000000\n" +
                                        list + "end_header\n0 0 0\n3 0 0 0\n",
                                    "ply\nformat ascii 1.0\nelement vertex 1\n" + vertices + "element face 1\n" + list +
                                        "end_header\n0 0 0\n4000000000 0 0 0\n",
                                    stl};
  for (const std::string order : {"little", "big"}) {
    const std::string start = "ply\nformat binary_" + order + "_endian 1.0\nelement vertex ";
    files.push_back(start + "4000000000\n" + vertices + "end_header\n" + std::string(200, '\0'));
    files.push_back(start + "4000000000\nproperty list uint char a\n" + vertices + "end_header\n" + std::string(200, '\0'));
    files.push_back(start + "1\n" + vertices + "element face 4000000000\n" + list + "end_header\n" + std::string(200, '\1'));
    files.push_back(start + "1\n" + vertices + "element face 2\nproperty list int int vertex_indices\nend_header\n" +
                    std::string(12, '\0') + std::string(200, '\x7F'));
    files.push_back(start + "1\n" + vertices + "element tristrips 2\nproperty list int int vertex_indices\nend_header\n" +
                    std::string(12, '\0') + std::string(200, '\x7F'));
    files.push_back(start + "18446744073709551615\nproperty double x\nproperty double y\nproperty double z\nend_header\n");
  }
  for (const std::string& file : files) {
    INFO(file.substr(0, 200));
    requested = 0;
    const Result<PolygonSoup> soup =
        import_memory(file, "mesh", {file.starts_with(' ') ? std::optional(Format::stl) : std::nullopt, {}});
    const std::size_t used = requested;
    CHECK_FALSE(soup);
    CHECK(used < 64 * 1024);
  }
}

TEST_CASE("a mesh costs a small multiple of its file") {
  std::string off = "OFF 60000 120000 0\n", obj,
              strips =
                  "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\n"
                  "property char y\nproperty char z\nelement tristrips 1\nproperty list int char vertex_indices\nend_header\n" +
                  std::string(9, '\0');
  for (int i = 0; i < 60'000; ++i)
    off += "0 0 0\n";
  for (int i = 0; i < 120'000; ++i)
    off += "0\n";
  for (int i = 0; i < 60'000; ++i)
    obj += "v 0 0 0\n";
  for (int i = 0; i < 120'000; ++i)
    obj += "f\n";
  std::string parts = "v 0 0 0\no " + std::string(1000, 'o') + "\nusemtl " + std::string(1000, 'm') + "\n";
  for (int i = 0; i < 200'000; ++i)
    parts += i % 2 == 0 ? "g a\nf\n" : "g\nf\n";
  std::string solids;
  for (int i = 0; i < 20'000; ++i)
    solids += "solid " + std::string(50, 's') + "\nfacet normal\nouter loop\nendloop\nendfacet\nendsolid\n";
  put<std::int32_t>(strips, 1'000'000);
  for (int i = 0; i < 1'000'000; ++i)
    strips += static_cast<char>(i % 3);
  for (const std::string& file : {off, obj, strips, parts, solids}) {
    INFO(file.substr(0, 200));
    requested = 0;
    const Result<PolygonSoup> soup = import_memory(file, "mesh");
    const std::size_t used = requested;
    CHECK(soup);
    CHECK(used < 40 * file.size());  // of all allocations ever made, growing vectors included
  }
}

namespace {

std::string gltf_with(const std::string& nodes, const std::string& accessor, const std::string& more = "") {
  return R"({"asset":{"version":"2.0"},"nodes":[)" + nodes +
         R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"componentType":5126,"type":"VEC3",)" +
         accessor + R"(}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:;base64,)" +
         std::string(48, 'A') + "\"}]" + more + "}";
}

}  // namespace

TEST_CASE("counts of four billion in glTF and Draco allocate no memory") {
  const std::string node = R"({"mesh":0})", huge = R"("count":4000000000)";
  std::string draco("DRACO\x02\x02\x01\x01\0\0\0", 12);  // edgebreaker: vertices, faces, no attributes, symbols, no splits
  for (const char* count : {"\x80\xC6\x86\x8F\x01", "\x80\xCA\xB5\xEE\x01", "\1", "\x80\xCA\xB5\xEE\x01", "\1"})
    draco += count;
  draco += std::string(15, '\1');
  for (const std::string& file :
       {gltf_with(node, huge), gltf_with(node, huge + R"(,"bufferView":0)"),
        gltf_with(node, huge + R"(,"sparse":{"count":4000000000,"indices":{"bufferView":0,"componentType":5125},)"
                               R"("values":{"bufferView":0}})"),
        gltf_with(node, R"("count":3,"bufferView":0)").replace(9, 6, "[[[[[["), draco}) {
    INFO(file.substr(0, 200));
    requested = 0;
    const Result<PolygonSoup> soup = import_memory(file, "mesh");
    const std::size_t used = requested;
    CHECK_FALSE(soup);
    CHECK(used < 64 * 1024);
  }
}

TEST_CASE("a scene with many instances is limited to a multiple of its file") {
  constexpr std::size_t kMultiple = 1500;  // 16 points, corners and their faces for each byte; their arrays grow by doubling
  for (const std::size_t points : {3, 3000}) {
    std::string nodes = R"({"mesh":0})";
    for (int i = 0; i < 10'000; ++i)
      nodes += R"(,{"mesh":0,"scale":[2,)" + std::to_string(i) + ",1]}";
    const std::string file = gltf_with(nodes, R"("count":)" + std::to_string(points));
    requested = 0;
    const Result<PolygonSoup> soup = import_memory(file, "mesh");
    const std::size_t used = requested;
    CHECK(used < kMultiple * file.size());
    REQUIRE(soup.has_value() == (points == 3));
    if (!soup) CHECK(soup.error().message.find("the limit for a file of this size") != std::string::npos);
    if (soup) CHECK(soup->face_count() == 10'001);
  }
}

TEST_CASE("JSON that glTF does not use costs a small multiple of its bytes") {
  for (const std::string item : {"[]", "{}", "0", "\"\"", R"({"":[]})", "[[[[[[[[]]]]]]]]"}) {
    std::string extras = ",\"extras\":[" + item;
    for (int i = 0; i < 100'000; ++i)
      extras += "," + item;
    const std::string file = gltf_with(R"({"mesh":0})", R"("count":3,"bufferView":0)", extras + "]");
    INFO(item);
    requested = 0;
    CHECK(import_memory(file, "mesh"));
    const std::size_t used = requested;
    CHECK(used < 100 * file.size());
  }
}
