// SPDX-License-Identifier: Apache-2.0
// The normal textures of a glTF file as images of heights in its soup.
#pragma once

#include "fdcg/bake.hpp"
#include "import/gltf_buffers.hpp"
#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

// Of materials that a face has, once the soup has its points, faces and texture coordinates, and its appearance's materials are
// the document's. How large a texel is on the mesh is the mean, over the area of all faces that are on the image, of the
// logarithm of the lengths along its rows and its columns: where they differ from face to face, slopes are felt smaller or
// larger by as much. Images whose normals are all upright are left out. Throws Refusal.
void add_normal_heights(const Document& document, Buffers& buffers, PolygonSoup& soup);

}  // namespace fdcg::bake::gltf
