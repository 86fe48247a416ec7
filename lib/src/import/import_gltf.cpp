// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 (Khronos), as JSON or in the binary container GLB: the container, and the sequence of stages. A reader of our own
// keeps every number exactly, names the place of each error and trusts no count. tinygltf does none of that, and loads images
// and files that the geometry does not need.
#include <cstring>
#include <string>

#include "import/gltf_buffers.hpp"
#include "import/gltf_document.hpp"
#include "import/gltf_scene.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

using gltf::Refusal;

constexpr std::string_view kMagic = "glTF";
constexpr std::size_t kHeaderBytes = 12;  // magic, version, length of all
constexpr std::size_t kChunkBytes = 8;    // length, type
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

struct Container {
  std::string_view json;
  std::optional<std::string_view> binary;
};

Refusal truncated(const std::string& what) {
  return Refusal{"truncated: " + what + "; fetch or export the file again"};
}

Container open_glb(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes + kChunkBytes) {
    throw truncated("a GLB starts with 20 bytes, the file has " + std::to_string(bytes.size()));
  }
  const std::uint32_t version = load_u32(bytes.data() + 4), length = load_u32(bytes.data() + 8);
  if (version != 2) throw Refusal{"is GLB version " + std::to_string(version) + "; version 2 is read: convert the file"};
  if (length > bytes.size()) {
    throw truncated("the GLB header promises " + std::to_string(length) + " bytes, the file has " +
                    std::to_string(bytes.size()));
  }
  if (bytes.find_first_not_of('\0', length) != std::string_view::npos) {
    throw Refusal{"contradicts itself: the GLB header promises " + std::to_string(length) + " bytes, the file has " +
                  std::to_string(bytes.size()) + "; fetch or export it again"};
  }
  Container container;
  std::size_t at = kHeaderBytes;
  for (std::size_t chunk = 0; at < length; ++chunk) {
    if (length - at < kChunkBytes) throw truncated("byte " + std::to_string(at) + ": a GLB chunk starts with 8 bytes");
    const std::uint32_t size = load_u32(bytes.data() + at), type = load_u32(bytes.data() + at + 4);
    at += kChunkBytes;
    if (size > length - at) {
      throw truncated("byte " + std::to_string(at) + ": GLB chunk " + std::to_string(chunk) + " promises " +
                      std::to_string(size) + " bytes, there are " + std::to_string(length - at));
    }
    if (chunk == 0 && type != kJsonChunk) throw Refusal{"its first GLB chunk is not JSON; export the file again"};
    if (chunk == 0) container.json = bytes.substr(at, size);
    if (chunk == 1 && type == kBinaryChunk) container.binary = bytes.substr(at, size);
    at += size;
  }
  return container;
}

// Shapes that have no faces, and no mesh beside them.
Failure refuse_shapes(const std::string& name, const std::vector<StatedShape>& shapes) {
  const StatedShape& first = shapes.front();
  const std::string count = shapes.size() == 1 ? "a shape" : std::to_string(shapes.size()) + " shapes, the first";
  return refuse(name,
                "holds no mesh but " + count + " of node '" + first.node + "', which " +
                    (first.kind.empty() ? first.problem + "; export it as a mesh"
                                        : "has no faces; a scene of fdcg-servo has it as \"surface\": " + surface_json(first)),
                "empty-mesh");
}

}  // namespace

bool is_gltf_json(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);  // UTF-8's byte-order mark
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && bytes[first] == '{' && bytes.find("\"asset\"") != std::string_view::npos;
}

bool is_glb(std::string_view bytes) {
  return bytes.starts_with(kMagic);
}

Result<PolygonSoup> read_gltf(const MeshText& input) {
  PolygonSoup soup;
  soup.name = input.name;
  soup.format = Format::gltf;
  soup.face_first.push_back(0);
  try {
    Container container{input.bytes, std::nullopt};
    if (is_glb(input.bytes)) container = open_glb(input.bytes);
    const gltf::Document document =
        gltf::parse_document(container.json, {input.wants_normals, input.wants_appearance, input.wants_heights, input.wants_haptics});
    gltf::Buffers buffers(document, container.binary, input.file);
    gltf::build_scene(document, buffers, input, soup);
    soup.other_files = buffers.outside_files();
    if (soup.face_count() == 0 && !soup.physics.shapes.empty()) return refuse_shapes(input.name, soup.physics.shapes);
  } catch (const Refusal& refusal) {
    return refuse(input.name, refusal.message, "unreadable");
  }
  return soup;
}

}  // namespace fdcg::bake
