// SPDX-License-Identifier: Apache-2.0
#include "graph/hierarchy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kBoxGrain = 1u << 9;
constexpr int kExponentBias = 127;
// The smallest cell of a grid: the step's rounding error, some 2^-19, stays far below 255 cells, the amount by which an unused
// box is inverted.
constexpr int kLeastCell = -24;
constexpr double kFarthest = 8;  // tree units: no box reaches further

struct Box {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};

  void add(const Box& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
};

using Boxes = std::array<Box, FDCG_TREE_WAYS>;

float float_below(double x) {
  const auto f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

// Chooses for one axis the finest grid whose 255 cells cover the boxes, then rounds each bound outwards to the next cell.
// origin + cell * number is exact in double, so that the comparison is with the value that a reader gets.
void put_on_grid(const Boxes& boxes, std::size_t count, std::size_t axis, const Box& around, fdcg_box8& record) {
  constexpr int kCells = 255;
  record.origin[axis] = float_below(around.low[axis]);
  const double origin = record.origin[axis];
  int exponent = std::max(kLeastCell, std::ilogb(std::max((around.high[axis] - origin) / kCells, std::ldexp(1.0, kLeastCell))));
  while (origin + kCells * std::ldexp(1.0, exponent) < around.high[axis])
    ++exponent;
  record.exponent[axis] = static_cast<std::uint8_t>(exponent + kExponentBias);
  const double cell = std::ldexp(1.0, exponent);
  for (std::size_t j = 0; j < FDCG_TREE_WAYS; ++j) {
    int low = kCells, high = 0;  // inverted: no box
    if (j < count) {
      low = std::clamp(static_cast<int>((boxes[j].low[axis] - origin) / cell), 0, kCells);
      while (origin + low * cell > boxes[j].low[axis])
        --low;
      high = std::clamp(static_cast<int>((boxes[j].high[axis] - origin) / cell), 0, kCells);
      while (origin + high * cell < boxes[j].high[axis])
        ++high;
    }
    record.low[axis][j] = static_cast<std::uint8_t>(low);
    record.high[axis][j] = static_cast<std::uint8_t>(high);
  }
}

// Writes the record of `count` boxes; returns the box around all of them as a reader will see them.
Box write_record(const Boxes& boxes, std::size_t count, fdcg_box8& record) {
  Box around;
  for (std::size_t j = 0; j < count; ++j)
    around.add(boxes[j]);
  record = {};
  Box seen;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_on_grid(boxes, count, axis, around, record);
    const double origin = record.origin[axis], cell = std::ldexp(1.0, record.exponent[axis] - kExponentBias);
    seen.low[axis] = origin + cell * *std::min_element(record.low[axis], record.low[axis] + count);
    seen.high[axis] = origin + cell * *std::max_element(record.high[axis], record.high[axis] + count);
  }
  return seen;
}

class TreeBuilder {
 public:
  TreeBuilder(const Graph& graph, const HierarchyScale& scale)
      : graph_(graph), per_unit_(std::ldexp(1.0, -std::ilogb(scale.extent))), max_deviation_(scale.max_deviation) {}

  [[nodiscard]] Box leaf(std::uint32_t leaf) const {
    Box box;
    const std::uint32_t first = leaf * FDCG_LEAF_NODES, end = std::min(first + FDCG_LEAF_NODES, graph_.node_count());
    for (std::uint32_t n = first; n < end; ++n) {
      const std::uint32_t region = graph_.region_of(n);
      const double margin = region == kNone || graph_.regions[region].is_exact ? 0 : max_deviation_;
      for (std::uint32_t side = graph_.first_side[n]; side < graph_.first_side[n + 1]; ++side) {
        const Vec3& p = graph_.points[graph_.corner[side]];
        for (int k = 0; k < 3; ++k) {
          const auto axis = static_cast<std::size_t>(k);
          box.low[axis] = std::min(box.low[axis], std::max(-kFarthest, (component(p, k) - margin) * per_unit_));
          box.high[axis] = std::max(box.high[axis], std::min(kFarthest, (component(p, k) + margin) * per_unit_));
        }
      }
    }
    return box;
  }

 private:
  const Graph& graph_;
  double per_unit_;  // a power of two: nothing is rounded
  double max_deviation_;
};

}  // namespace

std::vector<std::uint32_t> hierarchy_levels(std::uint32_t node_count) {
  std::uint32_t below = (node_count + FDCG_LEAF_NODES - 1) / FDCG_LEAF_NODES;
  std::vector<std::uint32_t> levels;
  do {
    below = (below + FDCG_TREE_WAYS - 1) / FDCG_TREE_WAYS;
    levels.push_back(below);
  } while (below > 1);
  std::reverse(levels.begin(), levels.end());
  return levels;
}

void build_hierarchy(const Graph& graph, const HierarchyScale& scale, std::span<fdcg_box8> records, unsigned jobs) {
  const TreeBuilder builder(graph, scale);
  const std::vector<std::uint32_t> levels = hierarchy_levels(graph.node_count());
  std::uint32_t items = (graph.node_count() + FDCG_LEAF_NODES - 1) / FDCG_LEAF_NODES;
  std::vector<Box> below;  // around each record of the level below; none below the leaves' records
  for (std::size_t level = levels.size(); level-- > 0;) {
    const std::span<fdcg_box8> here = records.last(levels[level]);
    records = records.first(records.size() - here.size());
    std::vector<Box> around(here.size());
    parallel_for(jobs, here.size(), kBoxGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Boxes boxes;
        const std::size_t first = i * FDCG_TREE_WAYS, count = std::min<std::size_t>(FDCG_TREE_WAYS, items - first);
        for (std::size_t j = 0; j < count; ++j)
          boxes[j] = below.empty() ? builder.leaf(static_cast<std::uint32_t>(first + j)) : below[first + j];
        around[i] = write_record(boxes, count, here[i]);
      }
    });
    below = std::move(around);
    items = levels[level];
  }
}

}  // namespace fdcg::bake
