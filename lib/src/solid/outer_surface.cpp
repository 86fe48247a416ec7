// SPDX-License-Identifier: Apache-2.0
#include "solid/outer_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/vec3.hpp"
#include "solid/arrangement.hpp"
#include "solid/outer_facets.hpp"

namespace fdcg::bake {
namespace {

constexpr int kMostRounds = 16, kFineRounds = 3;

double largest_coordinate(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points)
    largest = std::max(largest, largest_component(p));
  return largest;
}

class Rounding {
 public:
  // `step`: of a grid, a power of two; 0: none.
  Rounding(bool as_floats, double step) : as_floats_(as_floats), step_(step) {}
  [[nodiscard]] Vec3 operator()(const Vec3& p, bool is_coarse) const {
    return {rounded(p.x, is_coarse), rounded(p.y, is_coarse), rounded(p.z, is_coarse)};
  }

 private:
  [[nodiscard]] double rounded(double x, bool is_coarse) const {
    if (is_coarse && step_ > 0) x = step_ * std::nearbyint(x / step_);
    return as_floats_ ? static_cast<double>(static_cast<float>(x)) : x;
  }
  bool as_floats_;
  double step_;
};

// The outer facets with their points as numbers. The points of pieces go to the coarser grid.
FacetSet rounded(const Arrangement& arrangement, OuterFacets outer, const Rounding& rounding, double& moved) {
  const ExactPoints& points = *arrangement.points;
  std::vector<std::uint8_t> is_coarse(points.count(), 0), is_used(points.count(), 0);
  for (std::size_t f = 0; f < arrangement.facets.size(); ++f) {
    for (const PointId corner : arrangement.facets[f].corner)
      is_coarse[corner] |= arrangement.is_piece[f];
  }
  for (const Facet& facet : outer.facets) {
    for (const PointId corner : facet.corner)
      is_used[corner] = 1;
  }
  std::vector<Vec3> places(points.count());
  double farthest = 0;
  for (PointId p = 0; p < points.count(); ++p) {
    if (is_used[p] == 0) continue;
    places[p] = rounding(points.near(p), is_coarse[p] != 0);
    farthest = std::max(farthest, length(places[p] - points.near(p)) + 2 * points.error(p));
  }
  moved += farthest;
  return gathered(places, std::move(outer.facets));
}

}  // namespace

OuterSurface outer_surface(FacetSet set, const OuterSurfaceOptions& options) {
  using Outcome = OuterSurface::Outcome;
  OuterSurface result;
  int exponent = 0;
  (void)std::frexp(largest_coordinate(set.points), &exponent);
  for (; result.rounds < kMostRounds; ++result.rounds) {
    const Arrangement arrangement = arrange(set, options.jobs, options.progress);
    if (arrangement.outcome != Arrangement::Outcome::done) {
      const bool is_fault = arrangement.outcome == Arrangement::Outcome::fault;
      result.outcome = is_fault ? Outcome::fault : Outcome::too_many_pairs;
      return result;
    }
    OuterFacets outer = outer_facets(set, arrangement);
    if (!outer.is_closed) {
      result.outcome = result.rounds == 0 ? Outcome::not_closed : Outcome::fault;
      return result;
    }
    const bool is_first = result.rounds == 0;
    if (!is_first && arrangement.pairs == 0 && outer.facets.size() == set.facets.size()) {
      result.set = std::move(set);
      return result;
    }
    if (is_first) {
      result.pairs = arrangement.pairs;
      result.cut = arrangement.cut;
      result.inner = std::move(outer.inner);
    } else {
      result.met_again += arrangement.pairs;
    }
    // First the finest grid there is; then ones that grow from 2^-48 of the largest coordinate, of floats 2^-20.
    const int coarser = result.rounds - kFineRounds;
    const int finest = options.as_floats ? -22 : -50;
    const double step = coarser < 0 ? 0 : std::ldexp(1.0, exponent + finest + 2 * (coarser + 1));
    set = rounded(arrangement, std::move(outer), Rounding(options.as_floats, step), result.moved);
  }
  result.outcome = Outcome::not_settled;
  return result;
}

}  // namespace fdcg::bake
