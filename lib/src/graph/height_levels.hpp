// SPDX-License-Identifier: Apache-2.0
// The levels of a height map, for the sections HEIGHT_MAPS and HEIGHT_TEXELS.
#pragma once

#include <cstdint>
#include <vector>

#include "fdcg/appearance.hpp"
#include "fdcg/heights.h"

namespace fdcg::bake {

struct HeightLevels {
  fdcg_height_map map{};             // but for `first`
  std::vector<std::int16_t> texels;  // all levels
};

// The heights of an image about their mean, white `range_m` above black: as it is, and without what is shorter than 4, 8, 16,
// ... texels. Each level as coefficients of the spline of third degree through its texels. An image of one height gives
// map.metres_per_step 0. Cost: some 400 multiplications a texel. Same image, same texels, whatever `jobs`.
[[nodiscard]] HeightLevels height_levels(const HeightImage& image, double range_m, unsigned jobs);

}  // namespace fdcg::bake
