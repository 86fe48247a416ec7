// SPDX-License-Identifier: Apache-2.0
// Whether a polygon is simple: the rule self-crossing-face of validate, and the precondition of triangulation. All exact.
#pragma once

#include <optional>
#include <span>

#include "exact/projection.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// The sign of the polygon's signed area, projected along axis k = 0, 1, 2. Where the polygon crosses itself, regions count with
// their winding number.
[[nodiscard]] int area_sign(std::span<const Vec3> polygon, int k);

// The winding of the outline.
struct Turns {
  // The turning number, counter-clockwise: 1 for every simple counter-clockwise polygon. 0 where the outline has a spike or two
  // consecutive equal corners.
  int number = 0;
  bool has_right = false;  // some corner is reflex
};
[[nodiscard]] Turns turns_of(const Projection& view, std::span<const Vec3> polygon);

// Whether the outline is simple (no edges or corners touch or cross) and counter-clockwise; collinear corners are allowed.
// Linear where no corner is reflex, else n log n (sweep line of Shamos and Hoey 1976).
[[nodiscard]] bool is_simple(const Projection& view, std::span<const Vec3> polygon);

// A projection in which the polygon is simple and counter-clockwise. First the axis nearest to its mean normal is tried, then
// the other axes whose projection is not nearly edge-on, since a polygon far from planar may cross itself in one projection and
// not in another. None: it is simple in no projection. Costs at most three calls of is_simple().
[[nodiscard]] std::optional<Projection> simple_view(std::span<const Vec3> polygon);

}  // namespace fdcg::bake
