// SPDX-License-Identifier: Apache-2.0
#include "polygon_cut.hpp"

namespace fdcg::bake {
namespace {

// How often the direction of the boundary goes round, counter-clockwise: 1 for every simple polygon. 0 for a spike.
int turning_number(const Projection& projection, std::span<const Vec3> polygon) {
  const std::size_t count = polygon.size();
  const auto is_upward = [&](const Vec3& from, const Vec3& to) {
    return projection.v(to) != projection.v(from) ? projection.v(to) > projection.v(from)
                                                  : projection.u(to) > projection.u(from);
  };
  int turns = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % count], &c = polygon[(i + 2) % count];
    const int turn = projection.orient(a, b, c);
    if (turn == 0 && !projection.goes_on(a, b, c)) return 0;
    const bool first = is_upward(a, b), second = is_upward(b, c);
    if (turn > 0 && !first && second) ++turns;
    if (turn < 0 && first && !second) --turns;
  }
  return turns;
}

}  // namespace

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
      tip = next_[after];  // every other corner: round polygons are halved again and again, and no corner collects all cuts
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
  if (turning_number(projection, polygon) != 1) return {};
  not_convex_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (projection.orient(polygon[i > 0 ? i - 1 : count - 1], polygon[i], polygon[i + 1 < count ? i + 1 : 0]) <= 0)
      not_convex_.push_back(i);
  }
  constexpr std::uint64_t kMostTests = std::uint64_t{1} << 31;  // some ten seconds
  if (std::uint64_t{count} * not_convex_.size() > kMostTests) return {};
  return clip(count, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t) {
    if (projection.orient(polygon[a], polygon[b], polygon[c]) <= 0) return false;
    // A corner that was strictly convex at the start stays so and cannot be the one nearest to the tip. Corners cut off
    // already lie outside what remains; testing them too does no harm.
    for (const std::uint32_t i : not_convex_) {
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
