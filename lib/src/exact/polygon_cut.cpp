// SPDX-License-Identifier: Apache-2.0
#include "exact/polygon_cut.hpp"

#include <algorithm>

#include "exact/outline.hpp"

namespace fdcg::bake {
template <class IsEar>
std::span<const Ear> PolygonCutter::clip(std::uint32_t count, const IsEar& is_ear) {
  ears_.clear();
  next_.resize(count);
  previous_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    next_[i] = i + 1 < count ? i + 1 : 0;
    previous_[i] = i > 0 ? i - 1 : count - 1;
  }
  std::uint32_t tip = 0, left = count, misses = 0;
  while (left >= 3) {
    const std::uint32_t before = previous_[tip], after = next_[tip];
    if (is_ear(before, tip, after, left)) {
      ears_.push_back({before, tip, after});
      next_[before] = after;
      previous_[after] = before;
      --left;
      misses = 0;
      tip = next_[after];  // every other corner: convex polygons are halved repeatedly, and no corner gets all the diagonals
    } else if (++misses > left) {
      return {};
    } else {
      tip = after;
    }
  }
  return ears_;
}

std::span<const Ear> PolygonCutter::cut(const Projection& projection, std::span<const Vec3> polygon) {
  const auto count = static_cast<std::uint32_t>(polygon.size());
  if (turns_of(projection, polygon).number != 1) return {};
  not_convex_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (projection.orient(polygon[i > 0 ? i - 1 : count - 1], polygon[i], polygon[i + 1 < count ? i + 1 : 0]) <= 0)
      not_convex_.push_back(i);
  }
  const auto u = [&](std::uint32_t i) { return projection.u(polygon[i]); };
  std::sort(not_convex_.begin(), not_convex_.end(), [&](std::uint32_t i, std::uint32_t j) { return u(i) < u(j); });
  return clip(count, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t) {
    if (projection.orient(polygon[a], polygon[b], polygon[c]) <= 0) return false;
    // A corner that was strictly convex at the start stays so and cannot be the one nearest to the tip. Corners cut off
    // already lie outside what remains; testing them too does no harm.
    const auto [low, high] = std::minmax({u(a), u(b), u(c)});
    const auto first =
        std::lower_bound(not_convex_.begin(), not_convex_.end(), low, [&](std::uint32_t i, double x) { return u(i) < x; });
    for (auto at = first; at != not_convex_.end() && u(*at) <= high; ++at) {
      const std::uint32_t i = *at;
      if (i != a && i != b && i != c && next_[previous_[i]] == i &&
          projection.contains(polygon[a], polygon[b], polygon[c], polygon[i]))
        return false;
    }
    return true;
  });
}

std::span<const Ear> PolygonCutter::cut_star(const Projection& projection, std::span<const Vec3> polygon, const Vec3& kernel) {
  return clip(static_cast<std::uint32_t>(polygon.size()),
              [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t left) {
                return projection.orient(polygon[a], polygon[b], polygon[c]) > 0 &&
                       (left == 3 || projection.orient(polygon[a], polygon[c], kernel) >= 0);
              });
}

}  // namespace fdcg::bake
