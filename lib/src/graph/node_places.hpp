// SPDX-License-Identifier: Apache-2.0
// Where the triangles of a mesh lie on their images of heights, for the section NODE_PLACES.
#pragma once

#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/heights.h"
#include "graph/merge.hpp"
#include "graph/regions.hpp"
#include "graph/triangulate.hpp"

namespace fdcg::bake {

inline constexpr fdcg_node_place kFlatPlace = {{0, 0}, {{0, 0, 0}, {0, 0, 0}}, FDCG_NONE, 0};

struct NodePlaces {
  std::vector<fdcg_node_place> of_face;  // of each triangle; `map` is the number of an image of the soup
  std::uint64_t on_maps = 0;             // triangles that are on an image
};

// Of the triangles of `cut`, by the texture coordinates of the soup's corners. One without coordinates at a corner is on no
// image; likewise one with a corner that is no corner of its source face, as after a repair. Where the triangles of a region
// lie on one image by one linear function, within 1/64 of a texel, they share it; else each becomes a piece of its own, which
// keeps the region's plane and is merged with nothing. Linear.
[[nodiscard]] NodePlaces find_node_places(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face,
                                          const Triangulation& cut, Regions& regions);

// Those of the faces that the triangles became.
[[nodiscard]] std::vector<fdcg_node_place> places_of_faces(const NodePlaces& places, const Merged& faces);

}  // namespace fdcg::bake
