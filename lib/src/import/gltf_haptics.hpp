// SPDX-License-Identifier: Apache-2.0
// MPEG_haptic_material of a glTF file (ISO/IEC 23090-14; the extension's text in KhronosGroup/glTF), as an experiment: textures
// of stiffness and friction, read over the faces of the meshes that have them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "import/gltf_buffers.hpp"
#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

// Faces of one haptic material.
struct HapticRun {
  std::size_t first = 0, end = 0;  // of the soup
  std::uint32_t material = 0;      // in Document::haptics
};

// Of the document; empty where it has none. Throws Refusal, as the next one.
std::vector<Haptic> read_haptics(const json::Value& root, TextureReader& textures);
// Of an item of the document's meshes: the number of its haptic material, of `count`; or kNone.
Index haptic_of_mesh(const json::Value& mesh, std::size_t count);

// What the textures of each of the document's haptic materials hold over the faces that have it, by the first texture
// coordinates: 16 places of each triangle, weighted by its area. Fills StatedPhysics::haptic_materials. Throws Refusal.
void measure_haptics(const Document& document, Buffers& buffers, const std::vector<HapticRun>& runs, PolygonSoup& soup);

}  // namespace fdcg::bake::gltf
