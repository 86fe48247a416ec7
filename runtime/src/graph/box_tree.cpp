// SPDX-License-Identifier: Apache-2.0
#include "graph/box_tree.hpp"

#include "base/lanes.hpp"
#include "graph/tolerances.hpp"

namespace fdcg {

BoxTree::BoxTree(uint32_t nodes)
    : leaves(nodes / FDCG_LEAF_NODES + (nodes % FDCG_LEAF_NODES != 0 ? 1 : 0)), levels(0), records(0) {
  uint32_t count = leaves;
  do {
    count = count / FDCG_TREE_WAYS + (count % FDCG_TREE_WAYS != 0 ? 1 : 0);
    size[levels++] = count;
  } while (count > 1);
  for (int level = levels - 1; level >= 0; --level) {
    first[level] = records;
    records += size[level];
  }
}

void tree_way(const Vec3<float>& from, const Vec3<float>& along, float pad, TreeWay* way) {
  way->from[0] = from.x, way->from[1] = from.y, way->from[2] = from.z;
  const float ways[3] = {along.x, along.y, along.z};
  for (int k = 0; k < 3; ++k) {
    // A way shorter than the pad along an axis counts as that long: the boxes are grown by the pad too.
    const bool is_backwards = ways[k] < 0;
    const float length = absolute(ways[k]) < pad ? pad : absolute(ways[k]), per_length = 1 / length;
    way->per_way[k] = is_backwards ? -per_length : per_length;
    way->grow[k] = 2 * pad * per_length;
  }
}

[[gnu::cold]] bool cut_tree_way(const Vec3<double>& from, const Vec3<double>& to, TreeWay* way, double* begin, double* end) {
  constexpr double kAround = 16;  // no box reaches further than 8
  const Vec3<double> whole = to - from;
  const double size = norm1(from) + norm1(to);
  *begin = 0;
  *end = 1;
  if (size * DBL_EPSILON > 1.0 / 16) {
    *way = {{0, 0, 0}, {0, 0, 0}, {1, 1, 1}};
    return true;
  }
  const double at[3] = {from.x, from.y, from.z}, along[3] = {whole.x, whole.y, whole.z};
  for (int k = 0; k < 3; ++k) {
    if (absolute(along[k]) <= size * DBL_EPSILON) {  // too short to divide by: it stays where it is, up to rounding error
      if (absolute(at[k]) > kAround) return false;
      continue;
    }
    const double low = (-kAround - at[k]) / along[k], high = (kAround - at[k]) / along[k];
    const double in = low < high ? low : high, out = low < high ? high : low;
    if (in > *begin) *begin = in;
    if (out < *end) *end = out;
  }
  if (!(*begin < *end)) return false;
  const Vec3<double> start = from + whole * *begin, part = whole * (*end - *begin);
  const double near_size = norm1(start) + norm1(start + part);
  tree_way({static_cast<float>(start.x), static_cast<float>(start.y), static_cast<float>(start.z)},
           {static_cast<float>(part.x), static_cast<float>(part.y), static_cast<float>(part.z)},
           static_cast<float>(tree_rounding(near_size, size * DBL_EPSILON)), way);
  return true;
}

#if FDCG_HAS_VECTORS

uint32_t touched_boxes(const fdcg_box8& boxes, const TreeWay& way, float limit, float (&entry)[FDCG_TREE_WAYS]) {
  Lanes first = Lanes::all(0), last = Lanes::all(limit);
  for (int k = 0; k < 3; ++k) {
    const bool is_backwards = way.per_way[k] < 0;
    const float start = (boxes.origin[k] - way.from[k]) * way.per_way[k];
    const Lanes cell = Lanes::all(tree_cell(boxes.exponent[k]) * way.per_way[k]);
    const Lanes near_cells = Lanes::of(is_backwards ? boxes.high[k] : boxes.low[k]);
    const Lanes far_cells = Lanes::of(is_backwards ? boxes.low[k] : boxes.high[k]);
    first = greater(Lanes::all(start - way.grow[k]) + cell * near_cells, first);
    last = lesser(Lanes::all(start + way.grow[k]) + cell * far_cells, last);
  }
  first.store(entry);
  return where_at_most(first, last);
}

#else  // box by box: the same operations, and a third of the code that eight lanes in memory would take

uint32_t touched_boxes(const fdcg_box8& boxes, const TreeWay& way, float limit, float (&entry)[FDCG_TREE_WAYS]) {
  float start[3], cell[3];
  const uint8_t *near_cells[3], *far_cells[3];
  for (int k = 0; k < 3; ++k) {
    const bool is_backwards = way.per_way[k] < 0;
    start[k] = (boxes.origin[k] - way.from[k]) * way.per_way[k];
    cell[k] = tree_cell(boxes.exponent[k]) * way.per_way[k];
    near_cells[k] = is_backwards ? boxes.high[k] : boxes.low[k];
    far_cells[k] = is_backwards ? boxes.low[k] : boxes.high[k];
  }
  uint32_t touched = 0;
  for (uint32_t j = 0; j < FDCG_TREE_WAYS; ++j) {
    float first = 0, last = limit;
    for (int k = 0; k < 3; ++k) {
      const float in = (start[k] - way.grow[k]) + cell[k] * static_cast<float>(near_cells[k][j]);
      const float out = (start[k] + way.grow[k]) + cell[k] * static_cast<float>(far_cells[k][j]);
      if (in > first) first = in;
      if (out < last) last = out;
    }
    entry[j] = first;
    touched |= uint32_t{first <= last} << j;
  }
  return touched;
}

#endif

void WaitingBoxes::push(const Item& parent, uint32_t lanes, const float (&keys)[FDCG_TREE_WAYS]) {
  const int first = count_;
  for (uint32_t left = lanes; left != 0; left &= left - 1) {
    const auto j = static_cast<uint32_t>(__builtin_ctz(left));
    int at = count_++;
    for (; at > first && items_[at - 1].key < keys[j]; --at)
      items_[at] = items_[at - 1];
    items_[at] = {keys[j], parent.index * FDCG_TREE_WAYS + j, parent.level - 1};
  }
}

}  // namespace fdcg
