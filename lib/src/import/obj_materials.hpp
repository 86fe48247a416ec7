// SPDX-License-Identifier: Apache-2.0
// What the materials of an OBJ file look like: Kd, d and Tr of the libraries that its mtllib statements name, and their images
// of heights.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/appearance.hpp"

namespace fdcg::bake {

struct ObjMaterial {
  Colour colour = {1, 1, 1, 1};
  // Of map_bump, bump or disp, the first of them: what it says of the image, which is not read here. No name: there is none.
  HeightImage heights;
  std::string folder;  // of the library, as `mtllib` names it
};
using ObjMaterials = std::map<std::string, ObjMaterial, std::less<>>;

// Adds the materials of a library; of one that is there already the first counts. What cannot be read is left out.
void read_obj_materials(std::string_view library, const std::string& folder, ObjMaterials& materials);

}  // namespace fdcg::bake
