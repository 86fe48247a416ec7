// SPDX-License-Identifier: Apache-2.0
#include "validate/box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/hilbert.hpp"
#include "base/parallel.hpp"
#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kBoxGrain = 4096;
constexpr unsigned kKeyBits = 10;  // per coordinate: fine enough for the order, and key and index fit one word

std::uint32_t field(Cell cell, unsigned axis) {
  return static_cast<std::uint32_t>(cell >> (axis * (kCellBits + 1)) & ((Cell{1} << kCellBits) - 1));
}

std::uint64_t curve_key(const CellBox& box) {
  std::array<std::uint32_t, 3> middle{};
  for (unsigned axis = 0; axis < 3; ++axis)
    middle[axis] = (field(box.low, axis) + field(box.high, axis)) >> (kCellBits + 1 - kKeyBits);
  return hilbert_position(middle, kKeyBits) << 32;
}

// Least digit first; the digits are the upper halves' 3 x 10 bits.
void sort_by_upper_half(std::vector<std::uint64_t>& keys) {
  std::vector<std::uint64_t> sorted(keys.size());
  for (unsigned shift = 32; shift < 32 + 3 * kKeyBits; shift += kKeyBits) {
    std::array<std::uint32_t, std::size_t{1} << kKeyBits> place{};
    const auto digit = [&](std::uint64_t key) { return key >> shift & ((1u << kKeyBits) - 1); };
    for (const std::uint64_t key : keys)
      ++place[digit(key)];
    std::uint32_t sum = 0;
    for (std::uint32_t& entry : place) {
      const std::uint32_t count = entry;
      entry = sum;
      sum += count;
    }
    for (const std::uint64_t key : keys)
      sorted[place[digit(key)]++] = key;
    keys.swap(sorted);
  }
}

}  // namespace

CellGrid::CellGrid(const std::vector<Vec3>& points) {
  constexpr std::size_t kSamples = 4096;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> sample;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const std::size_t stride = points.size() / kSamples + 1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double half = component(points[i], k) / 2;
      if (!std::isfinite(half)) continue;
      low = std::min(low, half);
      high = std::max(high, half);
      if (i % stride == 0) sample.push_back(half);
    }
    if (!(low <= high)) low = high = 0;
    std::sort(sample.begin(), sample.end());
    Axis& axis = axes_[static_cast<std::size_t>(k)];
    for (std::size_t piece = 0; piece < kPieces; ++piece)
      axis.start[piece] = piece == 0 || sample.empty() ? low : sample[piece * sample.size() / kPieces];
    for (std::size_t piece = 0; piece < kPieces; ++piece) {
      const double width = (piece + 1 < kPieces ? axis.start[piece + 1] : high) - axis.start[piece];
      constexpr double kCells = 1u << (kCellBits - kPieceBits);
      axis.cells_per_unit[piece] = width > 0 ? std::min(kCells / width, std::numeric_limits<double>::max()) : 0;
    }
  }
}

// Monotonic in `half`: so are the search and, within a piece, subtraction, product and rounding down.
std::uint64_t CellGrid::place(const Axis& axis, double half) {
  std::size_t piece = 0;
  for (std::size_t step = kPieces / 2; step > 0; step /= 2)
    piece += axis.start[piece + step] <= half ? step : 0;
  constexpr unsigned kFineBits = kCellBits - kPieceBits;
  constexpr double kLast = (1u << kFineBits) - 1;
  // std::max of 0 and NaN, in this order, is 0: a NaN coordinate gets a valid cell.
  const double fine = std::min(std::max(0.0, (half - axis.start[piece]) * axis.cells_per_unit[piece]), kLast);
  return std::uint64_t{piece} << kFineBits | static_cast<std::uint64_t>(fine);
}

Cell CellGrid::cell(const Vec3& p) const {
  return place(axes_[0], p.x / 2) | place(axes_[1], p.y / 2) << (kCellBits + 1) |
         place(axes_[2], p.z / 2) << (2 * kCellBits + 2);
}

BoxTree::BoxTree(const std::vector<CellBox>& boxes, const std::vector<std::uint32_t>& labels, unsigned jobs) {
  std::vector<std::uint64_t> keys(boxes.size());
  parallel_for(jobs, boxes.size(), kBoxGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keys[i] = curve_key(boxes[i]) | i;
  });
  sort_by_upper_half(keys);
  order_.resize(boxes.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    order_[i] = static_cast<std::uint32_t>(keys[i]);
  if (!labels.empty()) {  // boxes of one label are consecutive, so that they share nodes
    std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) { return labels[i] < labels[j]; });
  }
  levels_.emplace_back(boxes.size());
  parallel_for(jobs, boxes.size(), kBoxGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      levels_[0][i] = boxes[order_[i]];
  });
  while (levels_.back().size() > 1) {
    const std::vector<CellBox>& below = levels_.back();
    std::vector<CellBox> above((below.size() + kArity - 1) / kArity);
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i % kArity == 0) above[i / kArity] = below[i];
      above[i / kArity].add(below[i]);
    }
    levels_.push_back(std::move(above));
  }
  if (!labels.empty()) label_levels(labels);
  while (levels_[part_level_].size() > kParts)
    ++part_level_;
}

void BoxTree::label_levels(const std::vector<std::uint32_t>& labels) {
  labels_.emplace_back(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i)
    labels_[0][i] = labels[order_[i]];
  while (labels_.size() < levels_.size()) {
    const std::vector<std::uint32_t>& below = labels_.back();
    std::vector<std::uint32_t> above(levels_[labels_.size()].size());
    for (std::size_t i = 0; i < below.size(); ++i) {
      std::uint32_t& label = above[i / kArity];
      label = i % kArity == 0 || label == below[i] ? below[i] : kNone;
    }
    labels_.push_back(std::move(above));
  }
}

}  // namespace fdcg::bake
