// SPDX-License-Identifier: Apache-2.0
// The hierarchy (format.h, fdcg_box8) as the step reads it: where its records stand, which of eight boxes a way touches, how
// far they are from a point. All in float and in tree units, whatever the graph's precision: the exact tests come after. Each
// lane of eight is the same few IEEE operations, so that a compiler may do four or eight at once and gets the same bits.
#pragma once

#include <string.h>

#include "fdcg/format.h"
#include "shared/vec.hpp"

namespace fdcg {

inline constexpr int kMostTreeLevels = 11;  // 2^32 nodes, four to a leaf, are 8^10 leaves

// Level 0 holds the records whose boxes are leaves, level levels - 1 the root; box j of record i on a level is around record
// 8 i + j of the level below, or leaf 8 i + j. Stored root first.
struct BoxTree {
  uint32_t leaves;
  int levels;
  uint32_t records;
  uint32_t first[kMostTreeLevels];  // record index of each level's first one
  uint32_t size[kMostTreeLevels];

  explicit BoxTree(uint32_t nodes);

  // How many children a level's records have: leaves, or the records of the level below.
  [[nodiscard]] uint32_t items_below(int level) const { return level == 0 ? leaves : size[level - 1]; }
  // A bit for each box that record i of a level has.
  [[nodiscard]] uint32_t lanes(int level, uint32_t i) const {
    const uint32_t count = items_below(level) - i * FDCG_TREE_WAYS;
    return count >= FDCG_TREE_WAYS ? 0xFFu : (1u << count) - 1;
  }
};

// The length of one tree unit in the file's: the power of two at or below the extent, so that no coordinate reaches 2.
inline double tree_unit(double extent) {
  uint64_t bits;
  memcpy(&bits, &extent, sizeof bits);
  bits &= 0x7FF0000000000000u;
  double unit;
  memcpy(&unit, &bits, sizeof unit);
  return unit;
}

// A cell's length along an axis.
inline float tree_cell(uint8_t exponent) {
  const uint32_t bits = uint32_t{exponent} << 23;
  float cell;
  memcpy(&cell, &bits, sizeof cell);
  return cell;
}

// A straight way in tree units. A box is touched where it would be after growing by `grow` ways to both sides, which is more
// than all rounding on the way here.
struct TreeWay {
  float from[3];
  float per_way[3];  // 1 / way
  float grow[3];     // fractions of the way
};

// A way near the tree. `pad`: tree_rounding.
void tree_way(const Vec3<float>& from, const Vec3<float>& along, float pad, TreeWay* way);

// The part of a way that is near the tree, from fraction *begin to *end. False: the way passes by. One from so far away that
// its coordinates say nothing of a box touches all.
bool cut_tree_way(const Vec3<double>& from, const Vec3<double>& to, TreeWay* way, double* begin, double* end);

// Which of a record's boxes the way enters at a fraction of at most `limit`, a bit each; entry[j]: at which, never too late.
uint32_t touched_boxes(const fdcg_box8& boxes, const TreeWay& way, float limit, float (&entry)[FDCG_TREE_WAYS]);

// The squared distances of a point from a record's boxes, up to rounding error. Returns which are at most `limit2`, a bit each.
uint32_t squared_distances(const fdcg_box8& boxes, const float (&point)[3], float limit2, float (&distance2)[FDCG_TREE_WAYS]);

// Records and leaves still to be looked at, the nearest of those that were added together on top.
class WaitingBoxes {
 public:
  struct Item {
    float key;       // entry or distance
    uint32_t index;  // within its level
    int level;       // -1: a leaf
  };

  explicit WaitingBoxes(const BoxTree& tree) { items_[count_++] = {0, 0, tree.levels - 1}; }

  [[nodiscard]] bool is_empty() const { return count_ == 0; }
  Item pop() { return items_[--count_]; }
  // Those of the eight boxes under `parent` that have their bit set.
  void push(const Item& parent, uint32_t lanes, const float (&keys)[FDCG_TREE_WAYS]);

 private:
  Item items_[(FDCG_TREE_WAYS - 1) * kMostTreeLevels + 1];  // each level adds at most seven
  int count_ = 0;
};

}  // namespace fdcg
