// SPDX-License-Identifier: Apache-2.0
// The arrays of a mesh as a page has them.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fdcg/bake.hpp"
#include "packed_array.hpp"

namespace fdcg::page {

struct PackedArray {
  nlohmann::ordered_json about;  // as described()
  std::string encoded;
};

// {"centre": [x, y, z], "size": s}: of the box about the finite points, source units.
nlohmann::ordered_json mesh_frame(const bake::PolygonSoup& soup);

// points (floats, from the centre), corners, and where there are any: sizes (of faces, unless all are triangles), face_lines,
// point_lines, face_materials.
std::vector<std::pair<std::string, PackedArray>> mesh_arrays(const bake::PolygonSoup& soup);

PackedArray graph_array(std::span<const std::byte> file);

}  // namespace fdcg::page
