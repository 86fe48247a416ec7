// SPDX-License-Identifier: Apache-2.0
// Materials of the nodes, from those of the source faces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/format.h"
#include "graph/merge.hpp"
#include "graph/regions.hpp"
#include "graph/triangulate.hpp"

namespace fdcg::bake {

// Splits regions where the material changes, so that no merged face has two materials. Each part keeps the plane of the region,
// bit for bit. `source_face`: the source face of each triangle; empty where they are the same. Does nothing where the soup has
// no materials. Linear.
void split_by_material(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face, const Triangulation& cut,
                       Regions& regions);

// Of each face of the merged mesh, or kNoMaterial; empty where the soup has none. `face_of_source` as SerialiseInput has it.
std::vector<std::uint16_t> material_of_faces(const PolygonSoup& soup, const Merged& faces,
                                             const std::vector<std::uint32_t>& face_of_source);

// A name as the file stores it: UTF-8, and distinct from other names also where it is cut.
fdcg_material_record material_record(const std::string& name);

}  // namespace fdcg::bake
