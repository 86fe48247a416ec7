// SPDX-License-Identifier: Apache-2.0
// Where the boxes of an implicit tree stand (format.h: a busy corner's tree): level 0 has one box for every
// `per_leaf` items, each level above one for two below; stored root first.
#pragma once

#include "fdcg/format.h"

namespace fdcg {

// Levels of a tree over as many items as an index can count, four to a leaf.
constexpr int kMaxLevels = 32;

// Level 0 holds the leaves' boxes, level count - 1 the root.
struct ImplicitTree {
  int levels = 0;
  uint64_t boxes = 0;
  uint64_t first[kMaxLevels];  // box index of each level's first box
  uint64_t size[kMaxLevels];   // boxes of each level

  ImplicitTree(uint32_t items, uint32_t per_leaf) {
    first[0] = size[0] = 0;
    if (items == 0) return;
    uint64_t count = (uint64_t{items} + per_leaf - 1) / per_leaf;
    for (;; count = (count + 1) / 2) {
      size[levels++] = count;
      if (count == 1) break;
    }
    for (int level = levels - 1; level >= 0; --level) {
      first[level] = boxes;
      boxes += size[level];
    }
  }
};

}  // namespace fdcg
