// SPDX-License-Identifier: Apache-2.0
#include "solid/facet_tree.hpp"

#include <algorithm>
#include <numeric>

namespace fdcg::bake {

FacetTree::FacetTree(const FacetSet& set) : order_(set.facets.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  std::vector<Vec3> middles;
  middles.reserve(set.facets.size());
  for (const Facet& facet : set.facets)
    middles.push_back(set.points[facet.corner[0]] + set.points[facet.corner[1]] + set.points[facet.corner[2]]);
  if (!order_.empty()) build(set, middles, 0, static_cast<std::uint32_t>(order_.size()));
}

// Halves at the median, so that it is no deeper than the logarithm. Returns the node.
std::uint32_t FacetTree::build(const FacetSet& set, const std::vector<Vec3>& middles, std::uint32_t first, std::uint32_t end) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  Vec3 low = set.points[set.facets[order_[first]].corner[0]], high = low;
  for (std::uint32_t i = first; i < end; ++i) {
    for (const std::uint32_t corner : set.facets[order_[i]].corner) {
      const Vec3& p = set.points[corner];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  constexpr std::uint32_t kLeaf = 4;
  nodes_.push_back({low, high, end - first <= kLeaf, first, end});
  if (end - first <= kLeaf) return number;
  const int axis = dominant_axis(high - low);
  const std::uint32_t half = first + (end - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + end,
                   [&](std::uint32_t s, std::uint32_t t) { return component(middles[s], axis) < component(middles[t], axis); });
  const std::uint32_t below = build(set, middles, first, half), above = build(set, middles, half, end);
  nodes_[number].first = below;
  nodes_[number].end = above;
  return number;
}

}  // namespace fdcg::bake
