// SPDX-License-Identifier: Apache-2.0
// Oriented triangles that count more than once, or backwards: what winding numbers are counted over.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solid/triangle_meeting.hpp"

namespace fdcg::bake {

struct Facet {
  Triangle3 corner{};        // counter-clockwise as seen from its front, the outside
  std::int32_t weight = 1;   // how many times it is there, less those of the other side; not 0
  std::uint32_t source = 0;  // a face of the input
};

struct FacetSet {
  std::vector<Vec3> points;
  std::vector<Facet> facets;
};

// Equal coordinates become one point; triangles without area go, since they enclose nothing; those on the same corners become
// one, and none where they cancel each other out. Points of no facet go. n log n.
[[nodiscard]] FacetSet gathered(std::span<const Vec3> points, std::vector<Facet> facets);

// One side of a facet.
struct FacetSide {
  std::uint32_t low, high;  // the ends, low < high
  std::uint32_t facet;
  bool is_upward;  // runs from low to high
};
// All sides, sorted by their ends and then by facet.
[[nodiscard]] std::vector<FacetSide> sides_of(const std::vector<Facet>& facets);

// Calls work(first, end) for the sides of each edge.
template <class Work>
void for_each_edge(const std::vector<FacetSide>& sides, const Work& work) {
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    while (end < sides.size() && sides[end].low == sides[first].low && sides[end].high == sides[first].high)
      ++end;
    work(sides.data() + first, sides.data() + end);
  }
}

// Along each edge the facets of either direction weigh the same: the winding number is whole everywhere.
[[nodiscard]] bool is_closed(const std::vector<Facet>& facets, const std::vector<FacetSide>& sides);

}  // namespace fdcg::bake
