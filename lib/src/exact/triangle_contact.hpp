// SPDX-License-Identifier: Apache-2.0
// Exact classification of how two triangles intersect, by orientation tests alone (after Guigue and Devillers, "Fast and robust
// triangle-triangle overlap test using orientation predicates", 2003).
#pragma once

#include <array>
#include <cstdint>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A triangle of the mesh, or one of the triangulation of a polygon. Two triangles share a corner where they point to the same
// Vec3. The corners are finite and not collinear.
struct ContactTriangle {
  std::array<const Vec3*, 3> corner{};
  std::uint8_t seams = 0;  // bit i: the side from corner i to the next is a diagonal inside a polygon
};

enum class Contact : std::uint8_t {
  none,      // no common point beside shared corners and a shared side that is no seam
  touching,  // other common points, but none in both interiors (seams count as interior)
  crossing,  // the interiors have a common point; so do coplanar triangles that overlap, and copies
};

// Exact. Some 50 ns; microseconds where signs are zero or nearly so.
[[nodiscard]] Contact contact_of(const ContactTriangle& a, const ContactTriangle& b);

// For triangles whose contact is not `none`: the midpoint of their intersection, rounded.
[[nodiscard]] Vec3 meeting_point(const ContactTriangle& a, const ContactTriangle& b);

}  // namespace fdcg::bake
