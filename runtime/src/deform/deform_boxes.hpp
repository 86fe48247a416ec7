// SPDX-License-Identifier: Apache-2.0
// The hierarchy of a mesh that moves: its records are those of the file (fdcg_box8, box_tree.hpp), and its boxes may change.
// Every box holds the boxes below it at all times. A corner that moves makes them larger where it must; they are made tight
// again one record at a time, when a step reads them.
#pragma once

#include "fdcg/fdcg.h"
#include "graph/box_tree.hpp"

namespace fdcg {

// The largest whole number not above x, |x| < 2^62. Not floor: that would need a C library.
inline double whole_below(double x) {
  const auto whole = static_cast<double>(static_cast<int64_t>(x));
  return whole > x ? whole - 1 : whole;
}

// In tree units. Whatever an fdcg_box8 says is exactly a double, and so is a corner's place in tree units.
struct TreeBox {
  double low[3], high[3];

  static TreeBox none() { return {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}}; }
  static TreeBox of(Vec3<double> p) { return {{p.x, p.y, p.z}, {p.x, p.y, p.z}}; }

  void add(const TreeBox& other) {
    for (int k = 0; k < 3; ++k) {
      if (other.low[k] < low[k]) low[k] = other.low[k];
      if (other.high[k] > high[k]) high[k] = other.high[k];
    }
  }
  [[nodiscard]] bool holds(const TreeBox& other) const {
    int is_out = 0;
    for (int k = 0; k < 3; ++k)
      is_out |= (other.low[k] < low[k]) | (other.high[k] > high[k]);
    return is_out == 0;
  }
};

inline TreeBox lane_of(const fdcg_box8& record, uint32_t j) {
  TreeBox box;
  for (int k = 0; k < 3; ++k) {
    const double origin = record.origin[k], cell = tree_cell(record.exponent[k]);
    box.low[k] = origin + cell * record.low[k][j];
    box.high[k] = origin + cell * record.high[k][j];
  }
  return box;
}

// Whether box j holds a point: lane_of without its corners.
inline bool holds_point(const fdcg_box8& record, uint32_t j, Vec3<double> p) {
  const double at[3] = {p.x, p.y, p.z};
  int is_out = 0;
  for (int k = 0; k < 3; ++k) {
    const double off = at[k] - double{record.origin[k]}, cell = tree_cell(record.exponent[k]);
    is_out |= (off < cell * record.low[k][j]) | (off > cell * record.high[k][j]);
  }
  return is_out == 0;
}

// The boxes with a bit in `lanes`, all together.
TreeBox around(const fdcg_box8& record, uint32_t lanes);

// Sets box j, rounded outwards. Where the grid does not reach, it is laid anew, the boxes of the other `lanes` grow, and true
// is returned.
bool set_lane(fdcg_box8* record, uint32_t lanes, uint32_t j, const TreeBox& box);

// Sets all boxes of `lanes`, rounded outwards. True: on a new grid, since the old one does not reach.
bool set_lanes(fdcg_box8* record, uint32_t lanes, const TreeBox (&boxes)[FDCG_TREE_WAYS]);

// Lays a grid anew that is much larger than the boxes on it. True: it did; boxes may reach further by the new grid's rounding.
bool has_finer_grid(fdcg_box8* record, uint32_t lanes);

}  // namespace fdcg
