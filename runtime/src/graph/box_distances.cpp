// SPDX-License-Identifier: Apache-2.0
// How far a point is from the boxes of the hierarchy: of its own, for programs that only sweep.
#include "base/lanes.hpp"
#include "graph/box_tree.hpp"

namespace fdcg {

#if FDCG_HAS_VECTORS

uint32_t squared_distances(const fdcg_box8& boxes, const float (&point)[3], float limit2, float (&distance2)[FDCG_TREE_WAYS]) {
  const Lanes none = Lanes::all(0);
  Lanes sum = none;
  for (int k = 0; k < 3; ++k) {
    const Lanes cell = Lanes::all(tree_cell(boxes.exponent[k])), start = Lanes::all(boxes.origin[k] - point[k]);
    const Lanes below = start + cell * Lanes::of(boxes.low[k]), above = -(start + cell * Lanes::of(boxes.high[k]));
    const Lanes gap = greater(greater(below, above), none);
    sum = sum + gap * gap;
  }
  sum.store(distance2);
  return where_at_most(sum, Lanes::all(limit2));
}

#else  // box by box, as in box_tree.cpp

uint32_t squared_distances(const fdcg_box8& boxes, const float (&point)[3], float limit2, float (&distance2)[FDCG_TREE_WAYS]) {
  uint32_t near = 0;
  for (uint32_t j = 0; j < FDCG_TREE_WAYS; ++j) {
    float sum = 0;
    for (int k = 0; k < 3; ++k) {
      const float cell = tree_cell(boxes.exponent[k]), start = boxes.origin[k] - point[k];
      const float below = start + cell * static_cast<float>(boxes.low[k][j]);
      const float above = -(start + cell * static_cast<float>(boxes.high[k][j]));
      const float nearest = below > above ? below : above, gap = nearest > 0 ? nearest : 0;
      sum = sum + gap * gap;
    }
    distance2[j] = sum;
    near |= uint32_t{sum <= limit2} << j;
  }
  return near;
}

#endif

}  // namespace fdcg
