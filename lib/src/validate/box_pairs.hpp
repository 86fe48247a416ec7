// SPDX-License-Identifier: Apache-2.0
// All overlapping pairs among a few million boxes (broad phase): a bounding volume hierarchy with four children per node, built
// by sorting along a space-filling curve and traversed against itself.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/ids.hpp"
#include "base/raw_array.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// Three coordinates as 20-bit integers packed into one word, each with a guard bit above it, so that three comparisons take one
// subtraction.
using Cell = std::uint64_t;
inline constexpr unsigned kCellBits = 20;
inline constexpr Cell kCellGuards =
    (Cell{1} << kCellBits) | (Cell{1} << (2 * kCellBits + 1)) | (Cell{1} << (3 * kCellBits + 2));

// Maps points to cells, monotonically on each axis: if two boxes of points overlap, so do their boxes of cells. Cells are finer
// where there are more points, so that neither outliers nor parts far apart make them too coarse.
class CellGrid {
 public:
  // Points that are not finite are ignored.
  CellGrid(const std::vector<Vec3>& points, unsigned jobs);
  [[nodiscard]] Cell cell(const Vec3& p) const;

 private:
  static constexpr unsigned kPieceBits = 8;
  static constexpr std::size_t kPieces = std::size_t{1} << kPieceBits;
  struct Axis {
    std::array<double, kPieces> start{};  // ascending; half of the coordinate, so that differences do not overflow
    std::array<double, kPieces> cells_per_unit{};
  };
  static std::uint64_t place(const Axis& axis, double half);
  std::array<Axis, 3> axes_;
};

struct CellBox {
  Cell low, high;  // `high` with its guards set

  [[nodiscard]] bool meets(const CellBox& other) const {
    return ((other.high - low) & (high - other.low) & kCellGuards) == kCellGuards;
  }
  static CellBox around(Cell cell) { return {cell, cell | kCellGuards}; }
  void add(const CellBox& other) {
    const Cell below = fields_not_below(low, other.low),
               above = fields_not_below(high & ~kCellGuards, other.high & ~kCellGuards);
    low = (other.low & below) | (low & ~below);
    high = (high & above) | (other.high & ~above) | kCellGuards;
  }

 private:
  // All ones in the fields where a >= b.
  static Cell fields_not_below(Cell a, Cell b) {
    const Cell guards = ((a | kCellGuards) - b) & kCellGuards;
    return guards - (guards >> kCellBits);
  }
};

class BoxTree {
 public:
  // Pairs of boxes with the same label are omitted and, where many boxes have it, skipped without a test. `labels`: of each
  // box, kNone for none; or empty.
  BoxTree(const RawArray<CellBox>& boxes, const std::vector<std::uint32_t>& labels, unsigned jobs);

  // The number of parts of the work, which can run concurrently and do not depend on the number of threads.
  [[nodiscard]] std::size_t part_count() const { return levels_[part_level_].size(); }

  [[nodiscard]] std::size_t size() const { return order_.size(); }
  // The number of the given box at a place of the tree.
  [[nodiscard]] std::uint32_t number(std::size_t place) const { return order_[place]; }

  // Calls visit(i, j) for the pairs of one part: places of the tree, always in the same order; over all parts each pair once.
  // Ends where visit returns false.
  template <class Visit>
  void for_each_pair(std::size_t part, Visit visit) const {
    if (within(part_level_, part, visit)) with_later_parts(levels_.size() - 1, 0, part, visit);
  }

 private:
  static constexpr std::size_t kArity = 4;
  static constexpr std::size_t kParts = 2048;  // at most; enough for a smooth progress bar and an even share of the work

  struct Children {
    std::size_t begin, end;
  };
  [[nodiscard]] Children children(std::size_t level, std::size_t node) const {
    const std::size_t count = levels_[level - 1].size(), begin = node * kArity;
    return {begin, begin + kArity < count ? begin + kArity : count};
  }

  // Each of the three returns false where a visit did.

  // Pairs of boxes in one subtree.
  template <class Visit>
  bool within(std::size_t level, std::size_t node, Visit& visit) const {
    if (level == 0 || label(level, node) != kNone) return true;
    const Children in = children(level, node);
    for (std::size_t i = in.begin; i < in.end; ++i) {
      if (!within(level - 1, i, visit)) return false;
      for (unsigned hits = meeting(level - 1, {i, i + 1}, {i + 1, in.end}); hits != 0; hits &= hits - 1) {
        if (!between(level - 1, i, i + 1 + static_cast<std::size_t>(std::countr_zero(hits)), visit)) return false;
      }
    }
    return true;
  }
  // Pairs of a box in one subtree with a box in another one.
  template <class Visit>
  bool between(std::size_t level, std::size_t a, std::size_t b, Visit& visit) const {
    if (have_same_label(level, a, b)) return true;
    if (level == 0) return visit(a, b);
    const Children in_a = children(level, a), in_b = children(level, b);
    for (unsigned hits = meeting(level - 1, in_a, in_b); hits != 0; hits &= hits - 1) {
      const auto hit = static_cast<std::size_t>(std::countr_zero(hits));
      if (!between(level - 1, in_a.begin + hit / kArity, in_b.begin + hit % kArity, visit)) return false;
    }
    return true;
  }
  // Bit kArity i + j: whether the i-th box of the one range meets the j-th of the other. All at once, since whether one does
  // can hardly be foretold.
  [[nodiscard]] unsigned meeting(std::size_t level, Children in_a, Children in_b) const {
    const CellBox *const first = levels_[level].data() + in_a.begin, *const second = levels_[level].data() + in_b.begin;
    const auto test = [&](std::size_t count, std::size_t other_count) {
      unsigned hits = 0;
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < other_count; ++j)
          hits |= static_cast<unsigned>(first[i].meets(second[j])) << (i * kArity + j);
      }
      return hits;
    };
    const std::size_t count = in_a.end - in_a.begin, other_count = in_b.end - in_b.begin;
    return count == kArity && other_count == kArity ? test(kArity, kArity) : test(count, other_count);  // most, unrolled
  }
  template <class Visit>
  bool with_later_parts(std::size_t level, std::size_t node, std::size_t part, Visit& visit) const {
    if (!levels_[level][node].meets(levels_[part_level_][part])) return true;
    if (level == part_level_) return node <= part || between(level, part, node, visit);
    const auto [begin, end] = children(level, node);
    for (std::size_t i = begin; i < end; ++i) {
      if (!with_later_parts(level - 1, i, part, visit)) return false;
    }
    return true;
  }

  [[nodiscard]] std::uint32_t label(std::size_t level, std::size_t node) const {
    return labels_.empty() ? kNone : labels_[level][node];
  }
  [[nodiscard]] bool have_same_label(std::size_t level, std::size_t a, std::size_t b) const {
    return !labels_.empty() && labels_[level][a] == labels_[level][b] && labels_[level][a] != kNone;
  }
  void label_levels(const std::vector<std::uint32_t>& labels);

  RawArray<std::uint32_t> order_;                   // the number of each box along the curve
  std::vector<RawArray<CellBox>> levels_;           // [0]: the boxes in that order
  std::vector<std::vector<std::uint32_t>> labels_;  // likewise: the common label of the boxes below; or empty
  std::size_t part_level_ = 0;
};

}  // namespace fdcg::bake
