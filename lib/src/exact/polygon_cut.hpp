// SPDX-License-Identifier: Apache-2.0
// Exact triangulation of a polygon by ear clipping.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exact/projection.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// An ear: the corners before, tip and after, neighbours in the polygon that was left when the tip was cut off. Indices into the
// polygon.
using Ear = std::array<std::uint32_t, 3>;

// Holds the working memory, so that cutting many small polygons allocates nothing.
class PolygonCutter {
 public:
  // The ears of a simple polygon in the order of cutting: count - 2 triangles, all strictly counter-clockwise; the last one is
  // the remaining triangle. Collinear corners are allowed. For a polygon that is not is_simple() the result may be empty. With
  // n corners, r of them not strictly convex, at most n r tests and usually few more than n: only corners in the range of an
  // ear are tested.
  std::span<const Ear> cut(const Projection& projection, std::span<const Vec3> polygon);

  // The same for a star-shaped polygon: every corner is visible from `kernel`, a point inside or on it. n tests. The result is
  // empty or all ears are strictly counter-clockwise; then it is a triangulation if the polygon is simple, whatever the kernel.
  std::span<const Ear> cut_star(const Projection& projection, std::span<const Vec3> polygon, const Vec3& kernel);

 private:
  template <class IsEar>
  std::span<const Ear> clip(std::uint32_t count, const IsEar& is_ear);

  std::vector<std::uint32_t> next_, previous_, not_convex_;
  std::vector<Ear> ears_;
};

}  // namespace fdcg::bake
