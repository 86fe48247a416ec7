// SPDX-License-Identifier: Apache-2.0
// The sections of height maps, from the soup's images and where the faces lie on them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/heights.h"
#include "graph/node_places.hpp"

namespace fdcg::bake {

struct HeightSections {
  std::vector<fdcg_node_place> place_of_face;  // of each face the graph was made of
  std::vector<fdcg_height_map> maps;
  std::vector<std::int16_t> texels;

  [[nodiscard]] bool is_empty() const { return maps.empty(); }
};

// What options.heights asks for and the soup has not; empty: it has.
[[nodiscard]] std::string missing_for_heights(const PolygonSoup& soup, const CompileOptions& options);

// Of the images that a face is on, in the soup's order. Fails (2) where no face is on any, an image is of one height, or a
// height is out of the format's range.
[[nodiscard]] Result<HeightSections> make_height_sections(const PolygonSoup& soup, std::vector<fdcg_node_place> place_of_face,
                                                          const CompileOptions& options, unsigned jobs);

}  // namespace fdcg::bake
