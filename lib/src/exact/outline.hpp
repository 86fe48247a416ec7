// SPDX-License-Identifier: Apache-2.0
// Does a polygon have an inside? What validate calls self-crossing-face, and what cutting into triangles needs. All exact.
#pragma once

#include <optional>
#include <span>

#include "exact/projection.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// The sign of the area enclosed by the polygon, seen along axis k = 0, 1, 2; of one that crosses itself, of what its windings
// add up to.
[[nodiscard]] int area_sign(std::span<const Vec3> polygon, int k);

// How the outline winds.
struct Turns {
  // How often its direction goes round, counter-clockwise: 1 for every polygon that does not meet itself and runs
  // counter-clockwise. 0 where it turns back on itself, or where two corners in a row are one.
  int number = 0;
  bool has_right = false;  // some corner points inwards
};
[[nodiscard]] Turns turns_of(const Projection& view, std::span<const Vec3> polygon);

// The outline meets itself nowhere, in edges or corners, and runs counter-clockwise; corners in a straight line are allowed.
// Linear where no corner points inwards, else n log n (Shamos and Hoey 1976: a line sweeps over the edges).
[[nodiscard]] bool is_simple(const Projection& view, std::span<const Vec3> polygon);

// The polygon seen along the axis nearest to its mean normal, from the side on which it runs counter-clockwise; where it is not
// simple there, along the other axes from which it is broad, since what is far from flat may cross itself in one view and not
// in another. None: it is simple in no view. At most three times is_simple().
[[nodiscard]] std::optional<Projection> simple_view(std::span<const Vec3> polygon);

}  // namespace fdcg::bake
