// SPDX-License-Identifier: Apache-2.0
// A rival's mesh in the types of the library that it links.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fdcg_rival.h"

namespace fdcg::rivals {

// make(const double*): of x, y, z in metres.
template <class Make>
auto points_of(const fdcg_rival_mesh& mesh, Make make) {
  std::vector<decltype(make(mesh.points_m))> points;
  points.reserve(static_cast<std::size_t>(mesh.point_count));
  for (std::uint64_t i = 0; i < mesh.point_count; ++i)
    points.push_back(make(mesh.points_m + 3 * i));
  return points;
}

// make(const std::uint32_t*): of three indices of points.
template <class Make>
auto triangles_of(const fdcg_rival_mesh& mesh, Make make) {
  std::vector<decltype(make(mesh.corners))> triangles;
  triangles.reserve(static_cast<std::size_t>(mesh.triangle_count));
  for (std::uint64_t t = 0; t < mesh.triangle_count; ++t)
    triangles.push_back(make(mesh.corners + 3 * t));
  return triangles;
}

}  // namespace fdcg::rivals
