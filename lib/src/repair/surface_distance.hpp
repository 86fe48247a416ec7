// SPDX-License-Identifier: Apache-2.0
// How far two surfaces are apart, measured.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// The triangles of a surface, with their sides as the faces show them.
using TriangleSet = std::vector<std::array<Vec3, 3>>;

// The faces that have an area and finite corners, polygons cut as compile cuts them; with `middle` as the origin. `mesh` is
// welded from the soup.
[[nodiscard]] TriangleSet triangles_of(const PolygonSoup& soup, const Mesh& mesh, const std::vector<FaceState>& states,
                                       const Vec3& middle);

// Of the tetrahedra between the origin and each triangle.
[[nodiscard]] double signed_volume(const TriangleSet& triangles);

struct SurfaceChange {
  double distance = 0;       // no point of either surface is farther from the other one
  double volume_change = 0;  // of signed_volume
};

// Compares two surfaces. Triangles that both have cost a sort, and add nothing: equal surfaces have distance 0, whatever the
// order and the sides of their triangles. Else `distance` is an upper bound, at most 1 % and 2^-26 of the largest coordinate
// above the true (Hausdorff) distance; where a proof takes too long, looser. Infinite where one of them is empty. Coordinates
// should be local.
[[nodiscard]] SurfaceChange surface_change(const TriangleSet& before, const TriangleSet& after);

}  // namespace fdcg::bake
