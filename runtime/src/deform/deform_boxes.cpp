// SPDX-License-Identifier: Apache-2.0
#include "deform/deform_boxes.hpp"

namespace fdcg {
namespace {

constexpr int kCells = 255, kExponentBias = 127;
// The smallest cell of a grid, as fdcg compile has it: a step's rounding, some 2^-19, stays far below the 255 cells by which an
// unused box is inside out. The largest: no box is larger than two places that a vertex may have are apart.
constexpr int kLeastExponent = kExponentBias - 24, kMostExponent = kExponentBias + 2;
constexpr double kHeadroom = 0.5;  // of a grid's size, to either side: corners that keep moving rarely need a new grid

// Coarse enough that origin + cell * number is exactly a double, and fine enough that no box grows by it.
double origin_below(double x) {
  constexpr double kPerUnit = 1 << 20;  // |x| < 8: 24 bits
  return whole_below(x * kPerUnit) / kPerUnit;
}

// The grid of one axis: room on both sides, and cells as small as hold that.
void lay_grid(fdcg_box8* record, int axis, double low, double high) {
  const double room = (high - low) * kHeadroom;
  record->origin[axis] = static_cast<float>(origin_below(low - room));
  int exponent = kLeastExponent;
  const auto end = [&] { return record->origin[axis] + kCells * double{tree_cell(static_cast<uint8_t>(exponent))}; };
  while (exponent < kMostExponent && end() < high + room)
    ++exponent;
  record->exponent[axis] = static_cast<uint8_t>(exponent);
}

// The last cell border at or below, the first at or above `x`; false where the grid does not reach.
bool cell_below(double x, double origin, double cell, uint8_t* number) {
  const double cells = (x - origin) / cell;  // a power of two: rounded only in the difference, which is looked at again
  if (!(cells >= 0 && cells <= kCells)) return false;
  auto n = static_cast<int>(cells);
  if (origin + n * cell > x) --n;
  *number = static_cast<uint8_t>(n < 0 ? 0 : n);
  return n >= 0;
}
bool cell_above(double x, double origin, double cell, uint8_t* number) {
  const double cells = (x - origin) / cell;
  if (!(cells >= 0 && cells <= kCells)) return false;
  auto n = static_cast<int>(cells);
  if (origin + n * cell < x) ++n;
  *number = static_cast<uint8_t>(n > kCells ? kCells : n);
  return n <= kCells;
}

bool put_on_grid(fdcg_box8* record, int axis, uint32_t j, double low, double high) {
  const double origin = record->origin[axis], cell = tree_cell(record->exponent[axis]);
  uint8_t first, last;
  if (!cell_below(low, origin, cell, &first) || !cell_above(high, origin, cell, &last)) return false;
  record->low[axis][j] = first;
  record->high[axis][j] = last;
  return true;
}

// The first and the last cell border of a record's boxes.
void reach_of(const fdcg_box8& record, uint32_t lanes, int axis, uint8_t* low, uint8_t* high) {
  *low = 255;
  *high = 0;
  for (uint32_t j = 0; lanes >> j != 0; ++j) {  // lanes begin with the first
    if (record.low[axis][j] < *low) *low = record.low[axis][j];
    if (record.high[axis][j] > *high) *high = record.high[axis][j];
  }
}

}  // namespace

TreeBox around(const fdcg_box8& record, uint32_t lanes) {
  TreeBox box;
  for (int k = 0; k < 3; ++k) {
    uint8_t low, high;
    reach_of(record, lanes, k, &low, &high);
    const double origin = record.origin[k], cell = tree_cell(record.exponent[k]);
    box.low[k] = origin + cell * low;
    box.high[k] = origin + cell * high;
  }
  return box;
}

bool set_lane(fdcg_box8* record, uint32_t lanes, uint32_t j, const TreeBox& box) {
  int is_on_grid = 1;
  for (int axis = 0; axis < 3; ++axis)
    is_on_grid &= put_on_grid(record, axis, j, box.low[axis], box.high[axis]);
  if (is_on_grid != 0) return false;
  TreeBox boxes[FDCG_TREE_WAYS];
  for (uint32_t left = lanes; left != 0; left &= left - 1) {
    const auto other = static_cast<uint32_t>(__builtin_ctz(left));
    boxes[other] = other == j ? box : lane_of(*record, other);
  }
  return set_lanes(record, lanes, boxes);
}

// The coarser grid is laid where the old one does not reach; a finer one by has_finer_grid alone.
bool set_lanes(fdcg_box8* record, uint32_t lanes, const TreeBox (&boxes)[FDCG_TREE_WAYS]) {
  TreeBox all = boxes[__builtin_ctz(lanes)];
  for (uint32_t left = lanes & (lanes - 1); left != 0; left &= left - 1)
    all.add(boxes[__builtin_ctz(left)]);
  bool has_new_grid = false;
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = record->origin[axis], reach = kCells * double{tree_cell(record->exponent[axis])};
    const bool is_none = record->exponent[axis] < kLeastExponent;  // of zeros
    if (is_none || all.low[axis] < origin || all.high[axis] > origin + reach) {
      lay_grid(record, axis, all.low[axis], all.high[axis]);
      has_new_grid = true;
    }
    for (uint32_t left = lanes; left != 0; left &= left - 1) {
      const auto j = static_cast<uint32_t>(__builtin_ctz(left));
      (void)put_on_grid(record, axis, j, boxes[j].low[axis], boxes[j].high[axis]);
    }
  }
  return has_new_grid;
}

bool has_finer_grid(fdcg_box8* record, uint32_t lanes) {
  constexpr int kMuchTooLarge = 16;
  bool has_new_grid = false;
  for (int axis = 0; axis < 3; ++axis) {
    uint8_t low, high;
    reach_of(*record, lanes, axis, &low, &high);
    if (record->exponent[axis] <= kLeastExponent || (high - low) * kMuchTooLarge >= kCells) continue;
    const fdcg_box8 old = *record;
    const double origin = old.origin[axis], cell = tree_cell(old.exponent[axis]);
    lay_grid(record, axis, origin + cell * low, origin + cell * high);
    for (uint32_t left = lanes; left != 0; left &= left - 1) {
      const auto j = static_cast<uint32_t>(__builtin_ctz(left));
      (void)put_on_grid(record, axis, j, origin + cell * old.low[axis][j], origin + cell * old.high[axis][j]);
    }
    has_new_grid = has_new_grid || record->exponent[axis] != old.exponent[axis];
  }
  return has_new_grid;
}

}  // namespace fdcg
