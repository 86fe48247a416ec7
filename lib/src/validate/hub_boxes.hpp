// SPDX-License-Identifier: Apache-2.0
// Hundreds of triangles around one vertex, or one edge, all share it, so all their boxes overlap and testing each pair would
// take quadratic time. Further common points can be excluded by the directions in which the triangles leave the hub.
#pragma once

#include <cstdint>
#include <vector>

#include "exact/triangle_contact.hpp"
#include "validate/box_pairs.hpp"

namespace fdcg::bake {

// Smallest number of triangles at a vertex for this method; below it, testing all pairs costs less.
inline constexpr std::uint32_t kHubTriangles = 512;

// Boxes of the directions from `hub`, a corner of all these triangles, to their points. Two of the triangles have more in
// common than the hub only if these boxes meet.
[[nodiscard]] RawArray<CellBox> boxes_around(const Vec3* hub, const std::vector<ContactTriangle>& triangles);

// Boxes of the triangles' normals, turned so that the side of all of them from `from` to `to` runs the same way. Two of the
// triangles have more in common than that side only if these boxes meet.
[[nodiscard]] RawArray<CellBox> boxes_around(const Vec3* from, const Vec3* to, const std::vector<ContactTriangle>& triangles);

}  // namespace fdcg::bake
