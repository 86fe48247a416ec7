// SPDX-License-Identifier: Apache-2.0
// glTF documents put together by hand, for tests of the reader.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gltf_writer.hpp"
#include "import_support.hpp"

namespace fdcg::test {

using Json = nlohmann::json;

enum Component { kI8 = 5120, kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kF32 = 5126 };

// A document whose buffer grows as accessors are added; json may be changed at will.
class GltfScene {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};

  // Bytes as a view of their own: its number.
  std::size_t view(const std::string& bytes, std::size_t stride = 0) {
    buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    buffer_ += bytes;
    json["bufferViews"].push_back(view);
    return json["bufferViews"].size() - 1;
  }

  template <class T>
  std::size_t accessor(const std::vector<T>& scalars, int component, const char* type) {
    std::string bytes;
    for (const T value : scalars)
      bake::test::put<T>(bytes, value);
    const std::size_t width = std::string(type) == "VEC3" ? 3 : 1;
    const std::size_t number = view(bytes);
    json["accessors"].push_back(
        {{"bufferView", number}, {"componentType", component}, {"type", type}, {"count", scalars.size() / width}});
    return json["accessors"].size() - 1;
  }
  std::size_t positions(const std::vector<float>& xyz) { return accessor(xyz, kF32, "VEC3"); }
  std::size_t indices(const std::vector<std::uint32_t>& list) { return accessor(list, kU32, "SCALAR"); }

  // A mesh of one primitive; further ones can be pushed to it.
  std::size_t mesh(const Json& primitive) {
    json["meshes"].push_back({{"primitives", {primitive}}});
    return json["meshes"].size() - 1;
  }
  // A node; a root of the scene unless told.
  std::size_t node(const Json& node, bool is_root = true) {
    json["nodes"].push_back(node);
    const std::size_t number = json["nodes"].size() - 1;
    if (is_root) json["scenes"][0]["nodes"].push_back(number);
    return number;
  }

  [[nodiscard]] const std::string& buffer() const { return buffer_; }
  [[nodiscard]] std::string text() const {
    Json whole = json;
    if (!whole.contains("buffers")) {
      whole["buffers"] = {{{"byteLength", buffer_.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer_)}}};
    }
    return whole.dump();
  }
  [[nodiscard]] std::string glb() const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", buffer_.size()}}};
    return glb_container(whole.dump(), buffer_);
  }

 private:
  std::string buffer_;
};

// A unit square in the plane z = 0, of two triangles, as mesh 0 with accessors 0 and 1; no node yet.
inline GltfScene square_mesh() {
  GltfScene scene;
  const std::size_t positions = scene.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  const std::size_t indices = scene.indices({0, 1, 2, 0, 2, 3});
  scene.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  return scene;
}

inline GltfScene square() {
  GltfScene scene = square_mesh();
  scene.node({{"mesh", 0}});
  return scene;
}

}  // namespace fdcg::test
