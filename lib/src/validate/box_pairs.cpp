// SPDX-License-Identifier: Apache-2.0
#include "validate/box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "base/hilbert.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kBoxGrain = 4096;
constexpr std::size_t kPointGrain = 16'384;
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

}  // namespace

CellGrid::CellGrid(const std::vector<Vec3>& points, unsigned jobs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::size_t kSamples = 4096;
  constexpr std::size_t kAxes = 3;
  std::array<double, kAxes> low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};
  std::mutex lock;
  parallel_for(jobs, points.size(), kPointGrain, [&](std::size_t begin, std::size_t end) {
    std::array<double, kAxes> least{kInfinity, kInfinity, kInfinity}, most{-kInfinity, -kInfinity, -kInfinity};
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < kAxes; ++k) {
        const double half = component(points[i], static_cast<int>(k)) / 2;
        if (!std::isfinite(half)) continue;
        least[k] = std::min(least[k], half);
        most[k] = std::max(most[k], half);
      }
    }
    const std::scoped_lock guard(lock);
    for (std::size_t k = 0; k < kAxes; ++k) {
      low[k] = std::min(low[k], least[k]);
      high[k] = std::max(high[k], most[k]);
    }
  });
  const std::size_t stride = points.size() / kSamples + 1;
  for (std::size_t k = 0; k < kAxes; ++k) {
    std::vector<double> sample;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      const double half = component(points[i], static_cast<int>(k)) / 2;
      if (std::isfinite(half)) sample.push_back(half);
    }
    if (!(low[k] <= high[k])) low[k] = high[k] = 0;
    std::sort(sample.begin(), sample.end());
    Axis& axis = axes_[k];
    for (std::size_t piece = 0; piece < kPieces; ++piece)
      axis.start[piece] = piece == 0 || sample.empty() ? low[k] : sample[piece * sample.size() / kPieces];
    for (std::size_t piece = 0; piece < kPieces; ++piece) {
      const double width = (piece + 1 < kPieces ? axis.start[piece + 1] : high[k]) - axis.start[piece];
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

BoxTree::BoxTree(const RawArray<CellBox>& boxes, const std::vector<std::uint32_t>& labels, unsigned jobs) {
  RawArray<std::uint64_t> keys(boxes.size());  // the position along the curve, then the number
  parallel_for(jobs, boxes.size(), kBoxGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keys[i] = curve_key(boxes[i]) | i;
  });
  radix_sort(keys, 3 * kKeyBits, jobs, [](std::uint64_t key) { return key >> 32; });
  order_ = RawArray<std::uint32_t>(boxes.size());
  parallel_for(jobs, boxes.size(), kBoxGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      order_[i] = static_cast<std::uint32_t>(keys[i]);
  });
  if (!labels.empty()) {  // boxes of one label are consecutive, so that they share nodes
    std::stable_sort(order_.data(), order_.data() + order_.size(),
                     [&](std::uint32_t i, std::uint32_t j) { return labels[i] < labels[j]; });
  }
  levels_.emplace_back(boxes.size());
  parallel_for(jobs, boxes.size(), kBoxGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      levels_[0][i] = boxes[order_[i]];
  });
  while (levels_.back().size() > 1) {
    const RawArray<CellBox>& below = levels_.back();
    RawArray<CellBox> above((below.size() + kArity - 1) / kArity);
    parallel_for(jobs, above.size(), kBoxGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        above[node] = below[node * kArity];
        for (std::size_t i = node * kArity + 1; i < std::min(below.size(), (node + 1) * kArity); ++i)
          above[node].add(below[i]);
      }
    });
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
