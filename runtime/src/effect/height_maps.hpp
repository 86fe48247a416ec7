// SPDX-License-Identifier: Apache-2.0
// Where the levels of a height map lie among its texels.
#pragma once

#include "fdcg/heights.h"

namespace fdcg {

struct HeightLevel {
  uint32_t width, height;
  uint64_t first;  // texel of the section
};

// Level 1 is as large as level 0; from there on each is half as large, rounded up.
inline uint32_t side_of_level(uint32_t side, uint32_t level) {
  const uint32_t halvings = level == 0 ? 0 : level - 1;
  return ((side - 1) >> halvings) + 1;
}

inline HeightLevel level_of(const fdcg_height_map& map, uint32_t level) {
  uint64_t first = map.first;
  for (uint32_t k = 0; k < level; ++k)
    first += uint64_t{side_of_level(map.width, k)} * side_of_level(map.height, k);
  return {side_of_level(map.width, level), side_of_level(map.height, level), first};
}

// A texel's column or row, of one that may be beyond the border.
inline uint32_t wrapped(int64_t at, uint32_t side, uint32_t wrap) {
  const auto size = static_cast<int64_t>(side);
  if (at >= 0 && at < size) return static_cast<uint32_t>(at);
  if (wrap == FDCG_WRAP_CLAMP) return at < 0 ? 0 : side - 1;
  if (wrap == FDCG_WRAP_REPEAT && (side & (side - 1)) == 0) return static_cast<uint32_t>(at) & (side - 1);  // no division
  const int64_t period = wrap == FDCG_WRAP_MIRROR ? 2 * size : size;
  int64_t in = at % period;
  if (in < 0) in += period;
  return static_cast<uint32_t>(in < size ? in : period - 1 - in);
}

}  // namespace fdcg
