// SPDX-License-Identifier: Apache-2.0
#include "solid/facets.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {
namespace {

// The first of the points at each one's coordinates.
std::vector<std::uint32_t> first_equal(std::span<const Vec3> points) {
  std::vector<std::uint32_t> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t v) { return std::tie(points[v].x, points[v].y, points[v].z); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

// The least corner first; the rest ascending, by turning the facet around where they are not.
Facet in_order(Facet facet) {
  Triangle3& c = facet.corner;
  std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  if (c[1] > c[2]) {
    std::swap(c[1], c[2]);
    facet.weight = -facet.weight;
  }
  return facet;
}

}  // namespace

FacetSet gathered(std::span<const Vec3> points, std::vector<Facet> facets) {
  const std::vector<std::uint32_t> first = first_equal(points);
  std::vector<Facet> sorted;
  sorted.reserve(facets.size());
  for (Facet& facet : facets) {
    for (std::uint32_t& corner : facet.corner)
      corner = first[corner];
    const auto [a, b, c] = facet.corner;
    if (a != b && b != c && c != a && !exact::collinear(points[a], points[b], points[c])) sorted.push_back(in_order(facet));
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const Facet& s, const Facet& t) { return s.corner < t.corner; });
  FacetSet set;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (!set.facets.empty() && set.facets.back().corner == sorted[i].corner) {
      set.facets.back().weight += sorted[i].weight;
    } else {
      if (!set.facets.empty() && set.facets.back().weight == 0) set.facets.pop_back();
      set.facets.push_back(sorted[i]);
    }
  }
  if (!set.facets.empty() && set.facets.back().weight == 0) set.facets.pop_back();
  std::sort(set.facets.begin(), set.facets.end(),
            [](const Facet& s, const Facet& t) { return std::tie(s.source, s.corner) < std::tie(t.source, t.corner); });
  constexpr std::uint32_t kUnused = 0xFFFFFFFFu;
  std::vector<std::uint32_t> number(points.size(), kUnused);
  for (Facet& facet : set.facets) {
    if (facet.weight < 0) {
      std::swap(facet.corner[1], facet.corner[2]);
      facet.weight = -facet.weight;
    }
    for (std::uint32_t& corner : facet.corner) {
      if (number[corner] == kUnused) {
        number[corner] = static_cast<std::uint32_t>(set.points.size());
        set.points.push_back(points[corner] + Vec3{});  // -0 becomes 0
      }
      corner = number[corner];
    }
  }
  return set;
}

std::vector<FacetSide> sides_of(const std::vector<Facet>& facets) {
  std::vector<FacetSide> sides;
  sides.reserve(3 * facets.size());
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = facets[f].corner[i], b = facets[f].corner[(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), f, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const FacetSide& s, const FacetSide& t) {
    return std::tie(s.low, s.high, s.facet, s.is_upward) < std::tie(t.low, t.high, t.facet, t.is_upward);
  });
  return sides;
}

bool is_closed(const std::vector<Facet>& facets, const std::vector<FacetSide>& sides) {
  bool is_even = true;
  for_each_edge(sides, [&](const FacetSide* first, const FacetSide* end) {
    std::int64_t sum = 0;
    for (; first != end; ++first)
      sum += first->is_upward ? facets[first->facet].weight : -facets[first->facet].weight;
    is_even = is_even && sum == 0;
  });
  return is_even;
}

}  // namespace fdcg::bake
