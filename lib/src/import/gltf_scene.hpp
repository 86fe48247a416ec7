// SPDX-License-Identifier: Apache-2.0
// From the scene's trees of nodes to one soup: each primitive once for each node that shows it, where that node's transforms
// put it.
#pragma once

#include <cstddef>

#include "import/gltf_buffers.hpp"
#include "import/gltf_document.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake::gltf {

// A scene may show a mesh many times, and so come to more than its file. The limit: as many points, and as many face corners,
// as 65,536 and 32 for each byte of the file, of the files beside it that it reads, and of its Draco data once decoded.
inline constexpr std::uint64_t kFreeElements = 1024;
inline constexpr std::uint64_t kElementsPerByte = 16;

// Fills points, faces, parts, ignored and the quanta. Throws Refusal.
void build_scene(const Document& document, Buffers& buffers, const MeshText& input, PolygonSoup& soup);

}  // namespace fdcg::bake::gltf
