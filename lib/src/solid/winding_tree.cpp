// SPDX-License-Identifier: Apache-2.0
#include "solid/winding_tree.hpp"

#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr double kFullAngle = 4 * 3.14159265358979323846;

// Van Oosterom and Strackee 1983. From a place in the triangle's plane, or within rounding of it, 0: of two that lie on one
// another and are turned against each other neither is seen.
double solid_angle(const WindingTree::Triangle& t, const Vec3& p) {
  const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const double la = length(a), lb = length(b), lc = length(c);
  const double above = dot(a, cross(b, c));
  const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  constexpr double kRounding = 1e-12;
  return std::fabs(above) <= kRounding * la * lb * lc ? 0 : 2 * std::atan2(above, below);
}

Vec3 middle_of(const WindingTree::Triangle& t) {
  return 1.0 / 3 * (t[0] + t[1] + t[2]);
}

}  // namespace

WindingTree::WindingTree(const std::vector<Triangle>& triangles) : triangles_(triangles) {
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::uint32_t WindingTree::build(std::uint32_t first, std::uint32_t end) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  double whole = 0;
  Vec3 low = triangles_[first][0], high = low;
  for (std::uint32_t i = first; i < end; ++i) {
    const Triangle& t = triangles_[i];
    const Vec3 normal = 0.5 * cross(t[1] - t[0], t[2] - t[0]);
    const double area = length(normal);
    node.normal = node.normal + normal;
    node.middle = node.middle + area * middle_of(t);
    whole += area;
    const Vec3 c = middle_of(t);
    low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
  }
  node.middle = whole > 0 ? 1 / whole * node.middle : triangles_[first][0];
  for (std::uint32_t i = first; i < end; ++i) {
    for (const Vec3& p : triangles_[i])
      node.radius = std::max(node.radius, length(p - node.middle));
  }
  constexpr std::uint32_t kLeaf = 8;
  node.first = first;
  node.end = end;
  node.is_leaf = end - first <= kLeaf;
  if (!node.is_leaf) {
    const int axis = dominant_axis(high - low);
    const std::uint32_t half = first + (end - first) / 2;
    std::nth_element(
        triangles_.begin() + first, triangles_.begin() + half, triangles_.begin() + end,
        [axis](const Triangle& s, const Triangle& t) { return component(middle_of(s), axis) < component(middle_of(t), axis); });
    node.first = build(first, half);
    node.end = build(half, end);
  }
  nodes_[number] = node;
  return number;
}

double WindingTree::at(const Vec3& p) const {
  if (nodes_.empty()) return 0;
  constexpr double kFar = 4;  // radii from which on a group counts as one: the sum is off by less than 0.01 then
  double sum = 0;
  std::uint32_t open[128] = {0};
  for (std::size_t count = 1; count > 0;) {
    const Node& node = nodes_[open[--count]];
    const Vec3 way = node.middle - p;
    const double squared = squared_length(way);
    if (squared > kFar * kFar * node.radius * node.radius) {
      sum += dot(way, node.normal) / (squared * std::sqrt(squared));
    } else if (node.is_leaf) {
      for (std::uint32_t i = node.first; i < node.end; ++i)
        sum += solid_angle(triangles_[i], p);
    } else {
      open[count++] = node.first;
      open[count++] = node.end;
    }
  }
  return sum / kFullAngle;
}

}  // namespace fdcg::bake
