// SPDX-License-Identifier: Apache-2.0
#include "solid/outer_surface.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/vec3.hpp"
#include "solid/arrangement.hpp"
#include "solid/outer_facets.hpp"

namespace fdcg::bake {
namespace {

constexpr int kMostRounds = 16, kFineRounds = 3;
constexpr double kNear = 0x1p-28, kNearFloats = 0x1p-22;  // of the size: made points closer together are joined

double largest_coordinate(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points)
    largest = std::max(largest, largest_component(p));
  return largest;
}

double extent_of(const std::vector<Vec3>& points) {
  Vec3 low = points.empty() ? Vec3{} : points[0], high = low;
  for (const Vec3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return length(high - low);
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

// Joins places that lie closer together than a distance, so that the surface has no edges that only rounding made.
class NearPlaces {
 public:
  explicit NearPlaces(double distance) : distance_(distance) {}

  // The place itself, or one that was kept before and lies within the distance.
  Vec3 joined(const Vec3& p) {
    if (const Vec3* const near = find(p)) return *near;
    keep(p);
    return p;
  }
  void keep(const Vec3& p) { kept_[key(cell(p.x), cell(p.y), cell(p.z))].push_back(p); }

 private:
  [[nodiscard]] std::int64_t cell(double x) const { return static_cast<std::int64_t>(std::floor(x / distance_)); }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {  // others may share it, which costs time alone
    return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15u ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Fu ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9u;
  }
  [[nodiscard]] const Vec3* find(const Vec3& p) const {
    for (int i = 0; i < 27; ++i) {
      const auto found = kept_.find(key(cell(p.x) + i % 3 - 1, cell(p.y) + i / 3 % 3 - 1, cell(p.z) + i / 9 - 1));
      if (found == kept_.end()) continue;
      for (const Vec3& q : found->second) {
        if (length(q - p) <= distance_) return &q;
      }
    }
    return nullptr;
  }

  double distance_;
  std::unordered_map<std::uint64_t, std::vector<Vec3>> kept_;
};

// The outer facets with their points as numbers. Made points join others that are near, given ones before made ones; in later
// rounds the points of pieces go to a coarser grid.
FacetSet rounded(const Arrangement& arrangement, std::size_t given, OuterFacets outer, const Rounding& rounding, double near,
                 double& moved) {
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
  NearPlaces kept(near);
  double farthest = 0;
  for (PointId p = 0; p < points.count(); ++p) {
    if (is_used[p] == 0) continue;
    places[p] = rounding(points.near(p), is_coarse[p] != 0);
    if (p >= given) {
      places[p] = kept.joined(places[p]);
    } else if (is_coarse[p] != 0) {
      kept.keep(places[p]);
    }
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
  const double near = std::max((options.as_floats ? kNearFloats : kNear) * extent_of(set.points),
                               std::ldexp(options.as_floats ? 0x1p-22 : 0x1p-50, exponent));
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
    set = rounded(arrangement, set.points.size(), std::move(outer), Rounding(options.as_floats, step), near, result.moved);
  }
  result.outcome = Outcome::not_settled;
  return result;
}

}  // namespace fdcg::bake
