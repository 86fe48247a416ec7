// SPDX-License-Identifier: Apache-2.0
// Flattens the node trees of a scene to one soup: each primitive once for each node that instances it, transformed to the world
// frame.
#pragma once

#include <cstddef>

#include "import/gltf_buffers.hpp"
#include "import/gltf_document.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake::gltf {

// A scene may instance a mesh many times, so that the soup is much larger than the file. Limit on the points, and on the face
// corners: 65,536 plus 32 for each byte of the file, of the other files that it reads, and of its decoded Draco data.
inline constexpr std::uint64_t kFreeElements = 1024;
inline constexpr std::uint64_t kElementsPerByte = 16;

// Fills points, faces, parts, ignored and the quanta. Throws Refusal.
void build_scene(const Document& document, Buffers& buffers, const MeshText& input, PolygonSoup& soup);

}  // namespace fdcg::bake::gltf
