// SPDX-License-Identifier: Apache-2.0
// What the materials of an OBJ file look like: Kd, d and Tr of the libraries that its mtllib statements name.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/appearance.hpp"

namespace fdcg::bake {

using ObjMaterials = std::map<std::string, Colour, std::less<>>;

// Adds the materials of a library; of one that is there already the first counts. What cannot be read is left out.
void read_obj_materials(std::string_view library, ObjMaterials& materials);

}  // namespace fdcg::bake
