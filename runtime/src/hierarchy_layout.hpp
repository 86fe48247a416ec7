// SPDX-License-Identifier: Apache-2.0
// Where the boxes of the implicit tree stand (format.h, fdcg_box).
#pragma once

#include "fdcg/format.h"

namespace fdcg {

// Levels of a tree over any number of nodes that an index can count: 2^32 / 4 leaves and the levels above.
constexpr int kMaxLevels = 32;

// Level 0 holds the leaves' boxes, level count - 1 the root.
struct HierarchyLayout {
  int levels = 0;
  uint64_t boxes = 0;
  uint64_t first[kMaxLevels] = {};  // box index of each level's first box
  uint64_t size[kMaxLevels] = {};   // boxes of each level

  explicit HierarchyLayout(uint32_t node_count) {
    if (node_count == 0) return;
    uint64_t count = (uint64_t{node_count} + FDCG_LEAF_NODES - 1) / FDCG_LEAF_NODES;
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
