// SPDX-License-Identifier: Apache-2.0
// EXT_meshopt_compression: what meshoptimizer's encoders wrote comes back bit by bit.
#include <meshoptimizer.h>

#include <algorithm>

#include "../../support/gltf_writer.hpp"
#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {

std::string view_json(std::size_t offset, std::size_t size, std::size_t stride, std::size_t count, const std::string& mode) {
  return "{\"buffer\":1,\"byteLength\":" + std::to_string(stride * count) +
         ",\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":" + std::to_string(offset) +
         ",\"byteLength\":" + std::to_string(size) + ",\"byteStride\":" + std::to_string(stride) +
         ",\"count\":" + std::to_string(count) + "," + mode + "}}}";
}

// A grid of 12 x 12 points with floats of many digits, and its triangles; packed.
struct Packed {
  std::vector<float> points;
  std::vector<unsigned> indices;
  std::string glb;

  explicit Packed(const std::string& mode = "\"mode\":\"ATTRIBUTES\"", std::size_t claimed = 144) {
    for (unsigned i = 0; i < 144; ++i)
      points.insert(points.end(),
                    {0.1f * static_cast<float>(i % 12), 0.3f * static_cast<float>(i / 12), 1.0f / static_cast<float>(i + 1)});
    for (unsigned i = 0; i < 131; ++i) {
      if (i % 12 != 11) indices.insert(indices.end(), {i, i + 1, i + 12, i + 1, i + 13, i + 12});
    }
    std::string vertex(meshopt_encodeVertexBufferBound(144, 12), '\0'),
        index(meshopt_encodeIndexBufferBound(indices.size(), 144), '\0');
    vertex.resize(
        meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(vertex.data()), vertex.size(), points.data(), 144, 12));
    index.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(index.data()), index.size(), indices.data(),
                                           indices.size()));
    const std::string json =
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"EXT_meshopt_compression\",\"EXT_mesh_manifold\"],"
        "\"buffers\":[{\"byteLength\":" +
        std::to_string(vertex.size() + index.size()) +
        "},{\"byteLength\":9999,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}],\"bufferViews\":[" +
        view_json(0, vertex.size(), 12, claimed, mode) + "," +
        view_json(vertex.size(), index.size(), 4, indices.size(), "\"mode\":\"TRIANGLES\"") +
        "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":144,\"type\":\"VEC3\"},{\"bufferView\":1,"
        "\"componentType\":5125,\"count\":" +
        std::to_string(indices.size()) +
        ",\"type\":\"SCALAR\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"nodes\":[{\"mesh\":0}]}";
    glb = fdcg::test::glb_container(json, vertex + index);
  }
};

}  // namespace

TEST_CASE("meshopt: positions and triangles come back exactly") {
  const Packed packed;
  const PolygonSoup soup = import_text(packed.glb);
  REQUIRE(soup.points.size() == 144);
  for (std::size_t i = 0; i < 144; ++i)
    CHECK(soup.points[i] == Vec3{packed.points[3 * i], packed.points[3 * i + 1], packed.points[3 * i + 2]});
  REQUIRE(soup.corners.size() == packed.indices.size());
  for (std::size_t t = 0; t < soup.face_count(); ++t) {  // the codec may turn a triangle's corners round
    std::array<std::uint32_t, 3> want{packed.indices[3 * t], packed.indices[3 * t + 1], packed.indices[3 * t + 2]};
    const std::array<std::uint32_t, 3> found{soup.corners[3 * t], soup.corners[3 * t + 1], soup.corners[3 * t + 2]};
    for (int turn = 0; turn < 3 && want != found; ++turn)
      std::rotate(want.begin(), want.begin() + 1, want.end());
    CHECK(want == found);
  }
}

TEST_CASE("meshopt: damaged data and counts beyond it are refused") {
  std::string damaged = Packed().glb;
  damaged.replace(damaged.size() - 40, 30, std::string(30, '\x7F'));
  const Result<PolygonSoup> soup = import_memory(damaged, "mesh");
  if (!soup) CHECK(soup.error().exit_code == 3);
  CHECK(refusal(Packed("\"mode\":\"ATTRIBUTES\"", 1'000'000'000).glb).find("more than its") != std::string::npos);
  CHECK(refusal(Packed("\"mode\":\"INDICES\"").glb).find(".byteStride is 12; of indices it is 2 or 4") != std::string::npos);
  CHECK(refusal(Packed("\"mode\":\"OTHER\"").glb).find("no name that the extension has") != std::string::npos);
  CHECK(refusal(Packed("\"mode\":\"ATTRIBUTES\",\"filter\":\"QUATERNION\"").glb).find("which its filter cannot have") !=
        std::string::npos);
}
