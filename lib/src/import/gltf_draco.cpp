// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_draco.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace fdcg::bake::gltf {

void SceneDraco::decode(const Document& document, std::span<const Index> shown, Buffers& buffers, std::size_t file_bytes) {
  std::vector<DracoInput> inputs;
  std::vector<std::string> places;
  std::size_t bytes = 0;
  for (const Index n : shown) {
    if (document.nodes[n].mesh == kNone) continue;
    const Mesh& mesh = document.meshes[document.nodes[n].mesh];
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const Primitive& primitive = mesh.primitives[p];
      if (!primitive.draco_view) continue;
      if (!number_of_.emplace(key_of(primitive), inputs.size()).second) continue;
      inputs.push_back({buffers.view(*primitive.draco_view), primitive.draco_positions, primitive.draco_extras, false});
      bytes += inputs.back().bytes.size();
      places.push_back("meshes[" + std::to_string(document.nodes[n].mesh) + "].primitives[" + std::to_string(p) + "]");
    }
  }
  if (inputs.empty()) return;
  bytes = std::min(bytes, file_bytes + buffers.outside_bytes());  // views may overlap
  decoded_ = decode_draco(inputs, draco_limits(bytes));
  if (!decoded_.trouble().empty()) throw Refusal{decoded_.refusal()};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const DracoMeshes::Mesh& mesh = decoded_.meshes()[i];
    if (mesh.is_point_cloud) throw Refusal{places[i] + ": its Draco data is a point cloud; compress a mesh"};
    if (!mesh.trouble.empty())
      throw Refusal{places[i] + ": its Draco data " + mesh.trouble + "; fetch the file or compress the mesh again"};
    constexpr std::size_t kBytes = 12;  // of three floats, of three corners: as it would be without Draco
    plain_bytes_ += mesh.points.size() * kBytes + mesh.corners.size() / 3 * kBytes;
  }
}

}  // namespace fdcg::bake::gltf
