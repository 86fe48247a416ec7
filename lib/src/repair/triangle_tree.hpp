// SPDX-License-Identifier: Apache-2.0
// A tree of boxes over triangles, for the nearest one and for those in a box.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "repair/surface_cover.hpp"

namespace fdcg::bake {

class TriangleTree {
 public:
  // The triangles must live as long. n log n.
  explicit TriangleTree(const std::vector<NamedTriangle>& triangles);

  struct Nearest {
    double distance;  // distance_bound to it
    std::uint32_t triangle;
  };
  // There must be a triangle.
  [[nodiscard]] Nearest nearest(const Vec3& p) const;

  // Replaces `out` by those triangles whose boxes, grown by `reach`, meet the box.
  void in_box(const Vec3& low, const Vec3& high, double reach, std::vector<NamedTriangle>& out) const;

 private:
  struct Box {
    Vec3 low, high;
    std::uint32_t first, end;  // of order_
  };
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t end);
  void grow(Box& box, std::uint32_t triangle) const;
  [[nodiscard]] static bool is_leaf(const Box& box);

  const std::vector<NamedTriangle>& triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;  // those of node i are at 2 i + 1 and 2 i + 2
};

}  // namespace fdcg::bake
