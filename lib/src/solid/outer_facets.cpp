// SPDX-License-Identifier: Apache-2.0
// Rays run along the axis nearest to the normal of the facet that they start from, through a point inside it. A ray that passes
// a corner or a side of another facet is decided as if it were moved by an infinitely small amount, less across than along
// (symbolic perturbation); facets that are seen edge-on are never passed then.
#include "solid/outer_facets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/vec3.hpp"
#include "solid/facet_tree.hpp"

namespace fdcg::bake {
namespace {

// Union of facets over edges of two.
std::vector<std::uint32_t> patches_of(const std::vector<Facet>& facets, const std::vector<FacetSide>& sides) {
  std::vector<std::uint32_t> leader(facets.size());
  std::iota(leader.begin(), leader.end(), 0U);
  const auto leader_of = [&](std::uint32_t f) {
    while (leader[f] != f)
      f = leader[f] = leader[leader[f]];
    return f;
  };
  for_each_edge(sides, [&](const FacetSide* first, const FacetSide* end) {
    if (end - first == 2) leader[leader_of(first[0].facet)] = leader_of(first[1].facet);
  });
  for (std::uint32_t f = 0; f < facets.size(); ++f)
    leader[f] = leader_of(f);
  return leader;
}

class RayCount {
 public:
  RayCount(const FacetSet& set, ExactPoints& points) : set_(set), points_(points), tree_(set) {}

  // The winding number in front of a facet of the arrangement.
  std::int64_t in_front(const Facet& facet) {
    const auto& [a, b, c] = facet.corner;
    const Vec3 normal = cross(points_.near(b) - points_.near(a), points_.near(c) - points_.near(a));
    int axis = dominant_axis(normal), facing = 0;
    for (int k = 0; k < 3 && facing == 0; ++k) {
      if (k != 0) axis = (axis + 1) % 3;
      facing = points_.orient2d(a, b, c, axis);
    }
    const PointId start = points_.middle(a, b, c);
    std::int64_t sum = 0;
    const double margin = points_.error(start);
    tree_.for_each_on_ray(points_.near(start), axis, margin, [&](std::uint32_t t) { sum += passed(start, t, axis); });
    return facing > 0 ? sum : sum - facet.weight;  // else the ray started behind it
  }

 private:
  // How much the winding number falls where the ray passes a facet of the set.
  std::int64_t passed(PointId start, std::uint32_t t, int axis) {
    const Triangle3& corner = set_.facets[t].corner;
    const int facing = points_.orient2d(corner[0], corner[1], corner[2], axis);
    if (facing == 0) return 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (facing * turn(corner[i], corner[(i + 1) % 3], start, axis) < 0) return 0;
    }
    // Behind a facet that faces along the ray, or in front of one that faces against it.
    return points_.side(corner, start) * facing < 0 ? facing * set_.facets[t].weight : 0;
  }
  // orient2d of the moved point; never 0 where a and b are apart.
  [[nodiscard]] int turn(PointId a, PointId b, PointId start, int axis) const {
    if (const int sign = points_.orient2d(a, b, start, axis); sign != 0) return sign;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (const int sign = points_.compare(a, b, v); sign != 0) return sign;
    return points_.compare(b, a, u);
  }

  const FacetSet& set_;
  ExactPoints& points_;
  FacetTree tree_;
};

// The facet of each patch from which rays start: the largest, since there the least is decided by fractions.
std::vector<std::uint32_t> largest_of(const std::vector<Facet>& facets, const std::vector<std::uint32_t>& patch,
                                      const ExactPoints& points) {
  std::vector<std::uint32_t> best(facets.size(), 0);
  std::vector<double> area(facets.size(), -1);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    const auto& [a, b, c] = facets[f].corner;
    const double size = squared_length(cross(points.near(b) - points.near(a), points.near(c) - points.near(a)));
    if (!(size > area[patch[f]])) continue;
    area[patch[f]] = size;
    best[patch[f]] = f;
  }
  return best;
}

}  // namespace

OuterFacets outer_facets(const FacetSet& set, const Arrangement& arrangement) {
  OuterFacets outer;
  const std::vector<Facet>& facets = arrangement.facets;
  const std::vector<FacetSide> sides = sides_of(facets);
  outer.is_closed = is_closed(facets, sides);
  if (!outer.is_closed) return outer;
  const std::vector<std::uint32_t> patch = patches_of(facets, sides);
  const std::vector<std::uint32_t> start = largest_of(facets, patch, *arrangement.points);
  RayCount rays(set, *arrangement.points);
  std::vector<std::uint8_t> is_outer(facets.size(), 0);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    if (patch[f] != f) continue;
    const Facet& from = facets[start[f]];
    const std::int64_t front = rays.in_front(from);
    is_outer[f] = front <= 0 && front + from.weight > 0;
  }
  std::vector<std::uint32_t> stays, goes;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    (is_outer[patch[f]] != 0 ? stays : goes).push_back(facets[f].source);
    if (is_outer[patch[f]] == 0) continue;
    outer.facets.push_back(facets[f]);
    outer.facets.back().weight = 1;
  }
  for (std::vector<std::uint32_t>* sources : {&stays, &goes}) {
    std::sort(sources->begin(), sources->end());
    sources->erase(std::unique(sources->begin(), sources->end()), sources->end());
  }
  std::set_difference(goes.begin(), goes.end(), stays.begin(), stays.end(), std::back_inserter(outer.inner));
  return outer;
}

}  // namespace fdcg::bake
