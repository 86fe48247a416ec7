// SPDX-License-Identifier: Apache-2.0
// Cutting a polygon into triangles by clipping ears, exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exact/projection.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// An ear: corners before, tip, after of the polygon as it stood when the tip was cut off. Indices into the polygon.
using Ear = std::array<std::uint32_t, 3>;

// Holds the working memory, so that cutting many small polygons allocates nothing.
class PolygonCutter {
 public:
  // The ears of a simple polygon in the order of cutting, count - 2 of them, all turning strictly left, the last one what
  // remains; corners in a straight line are allowed. Of a polygon that is_simple() refuses perhaps none. Of n corners, r of
  // them not strictly convex, n r tests at most, and as a rule few more than n: only corners level with an ear are looked at.
  std::span<const Ear> cut(const Projection& projection, std::span<const Vec3> polygon);

  // The same for a polygon every corner of which is visible from `kernel`, inside or on it: n tests. All ears turn strictly
  // left or the result is empty; it is then a triangulation if the polygon is simple, whatever the kernel.
  std::span<const Ear> cut_star(const Projection& projection, std::span<const Vec3> polygon, const Vec3& kernel);

 private:
  template <class IsEar>
  std::span<const Ear> clip(std::uint32_t count, const IsEar& is_ear);

  std::vector<std::uint32_t> next_, previous_, not_convex_;
  std::vector<Ear> ears_;
};

}  // namespace fdcg::bake
