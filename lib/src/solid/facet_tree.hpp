// SPDX-License-Identifier: Apache-2.0
// A tree of boxes over facets, for those that a line along an axis may pass.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.hpp"
#include "solid/facets.hpp"

namespace fdcg::bake {

class FacetTree {
 public:
  explicit FacetTree(const FacetSet& set);

  // Calls visit(facet) for each whose box meets, grown by `margin`, the ray from a point in the direction of growing
  // coordinates along the axis.
  template <class Visit>
  void for_each_on_ray(const Vec3& from, int axis, double margin, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::uint32_t open[64] = {0};
    for (std::size_t count = 1; count > 0;) {
      const Node& node = nodes_[open[--count]];
      if (!is_passed(node, from, axis, margin)) continue;
      if (node.is_leaf) {
        for (std::uint32_t i = node.first; i < node.end; ++i)
          visit(order_[i]);
      } else {
        open[count++] = node.first;
        open[count++] = node.end;
      }
    }
  }

 private:
  struct Node {
    Vec3 low, high;
    bool is_leaf;
    std::uint32_t first, end;  // a leaf's places in order_; else the two nodes below
  };
  [[nodiscard]] static bool is_passed(const Node& node, const Vec3& from, int axis, double margin) {
    for (int k = 0; k < 3; ++k) {
      if (component(from, k) > component(node.high, k) + margin) return false;
      if (k != axis && component(from, k) < component(node.low, k) - margin) return false;
    }
    return true;
  }
  std::uint32_t build(const FacetSet& set, const std::vector<Vec3>& middles, std::uint32_t first, std::uint32_t end);

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace fdcg::bake
