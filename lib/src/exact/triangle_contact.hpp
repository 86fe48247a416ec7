// SPDX-License-Identifier: Apache-2.0
// How two triangles meet, exactly. Decided by the signs of orientations alone; the same signs that say whether they meet, as in
// Guigue and Devillers, "Fast and robust triangle-triangle overlap test using orientation predicates" (2003), also say how.
#pragma once

#include <array>
#include <cstdint>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A triangle of the mesh, or one that a polygon was cut into. Two triangles share a corner where they point to the same Vec3.
// Finite, and not on a line.
struct ContactTriangle {
  std::array<const Vec3*, 3> corner{};
  std::uint8_t seams = 0;  // bit i: the side from corner i to the next is a cut through a polygon, inside of it
};

enum class Contact : std::uint8_t {
  none,      // they have nothing in common but shared corners and a shared side (one that is no seam)
  touching,  // they have, but their interiors, seams included, have not
  crossing,  // their interiors have a point in common; triangles in one plane then overlap, and copies do so
};

// Exact. Some 50 ns; microseconds where signs are zero or nearly so.
[[nodiscard]] Contact contact_of(const ContactTriangle& a, const ContactTriangle& b);

// For triangles whose contact is not `none`: the middle of what they have in common, rounded.
[[nodiscard]] Vec3 meeting_point(const ContactTriangle& a, const ContactTriangle& b);

}  // namespace fdcg::bake
