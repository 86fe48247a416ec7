// SPDX-License-Identifier: Apache-2.0
// The Draco data of a glTF scene: of all primitives at once, in one child process.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <tuple>

#include "import/draco_decode.hpp"
#include "import/gltf_buffers.hpp"
#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

class SceneDraco {
 public:
  // Of the nodes that are shown. `file_bytes`: of the glTF file itself. Throws Refusal.
  void decode(const Document& document, std::span<const Index> shown, Buffers& buffers, std::size_t file_bytes);

  // Of a primitive of these that has a draco_view.
  [[nodiscard]] const DracoMeshes::Mesh& mesh_of(const Primitive& primitive) const {
    return decoded_.meshes()[number_of_.at(key_of(primitive))];
  }
  // As the points and corners would take without Draco.
  [[nodiscard]] std::uint64_t plain_bytes() const { return plain_bytes_; }

 private:
  using Key = std::tuple<Index, std::uint32_t, DracoExtraIds>;  // view, unique ids
  static Key key_of(const Primitive& primitive) {
    return {*primitive.draco_view, primitive.draco_positions, primitive.draco_extras};
  }
  std::map<Key, std::size_t> number_of_;
  DracoMeshes decoded_;
  std::uint64_t plain_bytes_ = 0;
};

}  // namespace fdcg::bake::gltf
