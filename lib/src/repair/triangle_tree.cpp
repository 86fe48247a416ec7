// SPDX-License-Identifier: Apache-2.0
#include "repair/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr std::uint32_t kLeaf = 4;

double beyond(double low, double high, double x) {
  return x < low ? low - x : x > high ? x - high : 0;
}

}  // namespace

TriangleTree::TriangleTree(const std::vector<NamedTriangle>& triangles) : triangles_(triangles), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!order_.empty()) build(0, 0, static_cast<std::uint32_t>(order_.size()));
}

bool TriangleTree::is_leaf(const Box& box) {
  return box.end - box.first <= kLeaf;
}

void TriangleTree::grow(Box& box, std::uint32_t triangle) const {
  for (const Vec3& p : triangles_[triangle].point) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
}

void TriangleTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t end) {
  if (boxes_.size() <= node) boxes_.resize(node + 1);
  const Vec3& any = triangles_[order_[first]].point[0];
  Box box{any, any, first, end};
  for (std::uint32_t i = first; i < end; ++i)
    grow(box, order_[i]);
  boxes_[node] = box;
  if (is_leaf(box)) return;
  const int axis = dominant_axis(box.high - box.low);
  const std::uint32_t middle = first + (end - first) / 2;
  const auto key = [&](std::uint32_t t) {
    const auto& p = triangles_[t].point;
    return component(p[0], axis) + component(p[1], axis) + component(p[2], axis);
  };
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t s, std::uint32_t t) { return key(s) < key(t); });
  build(2 * node + 1, first, middle);
  build(2 * node + 2, middle, end);
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& p) const {
  Nearest best{std::numeric_limits<double>::infinity(), 0};
  std::vector<std::pair<double, std::uint32_t>> open{{0, 0}};
  const auto distance_to = [&](std::uint32_t node) {
    const Box& b = boxes_[node];
    return length({beyond(b.low.x, b.high.x, p.x), beyond(b.low.y, b.high.y, p.y), beyond(b.low.z, b.high.z, p.z)});
  };
  while (!open.empty()) {
    const auto [distance, node] = open.back();
    open.pop_back();
    if (!(distance < best.distance)) continue;
    const Box& box = boxes_[node];
    if (is_leaf(box)) {
      for (std::uint32_t i = box.first; i < box.end; ++i) {
        const double d = distance_bound(p, triangles_[order_[i]].point);
        if (d < best.distance) best = {d, order_[i]};
      }
      continue;
    }
    std::pair<double, std::uint32_t> near{distance_to(2 * node + 1), 2 * node + 1},
        far{distance_to(2 * node + 2), 2 * node + 2};
    if (far.first < near.first) std::swap(near, far);
    open.push_back(far);
    open.push_back(near);
  }
  return best;
}

void TriangleTree::in_box(const Vec3& low, const Vec3& high, double reach, std::vector<NamedTriangle>& out) const {
  out.clear();
  std::vector<std::uint32_t> open{0};
  const auto meets = [&](const Box& b) {
    return b.low.x - reach <= high.x && low.x <= b.high.x + reach && b.low.y - reach <= high.y && low.y <= b.high.y + reach &&
           b.low.z - reach <= high.z && low.z <= b.high.z + reach;
  };
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    const Box& box = boxes_[node];
    if (!meets(box)) continue;
    if (!is_leaf(box)) {
      open.push_back(2 * node + 1);
      open.push_back(2 * node + 2);
      continue;
    }
    for (std::uint32_t i = box.first; i < box.end; ++i) {
      Box own{triangles_[order_[i]].point[0], triangles_[order_[i]].point[0], 0, 0};
      grow(own, order_[i]);
      if (meets(own)) out.push_back(triangles_[order_[i]]);
    }
  }
}

}  // namespace fdcg::bake
