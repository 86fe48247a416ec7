// SPDX-License-Identifier: Apache-2.0
// The normal that shading interpolates, computed apart from the runtime.
#pragma once

#include <cmath>

#include "contact_rig.hpp"

namespace fdcg::test {

// The unit normal of a node of three sides at a point of the object's frame, by its shares there.
inline Hip shaded_normal(const fdcg_graph& graph, std::uint32_t node, const Hip& point_m) {
  double normals[9];
  fdcg_get_node_normals(&graph, node, normals);
  Hip corner[3], x = point_m, normal{};
  for (std::uint32_t k = 0; k < 3; ++k) {
    const fdcg_corner_info info = fdcg_get_corner(&graph, fdcg_get_side(&graph, node, k).corner);
    corner[k] = {info.point[0], info.point[1], info.point[2]};
  }
  for (std::size_t c = 0; c < 3; ++c)
    x[c] = x[c] / graph.header->metres_per_unit - graph.header->origin[c];
  const Hip a = difference(corner[1], corner[0]), b = difference(corner[2], corner[0]), p = difference(x, corner[0]);
  const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), pa = dot(p, a), pb = dot(p, b), size = aa * bb - ab * ab;
  const double s = (pa * bb - pb * ab) / size, t = (aa * pb - ab * pa) / size;
  for (std::size_t c = 0; c < 3; ++c)
    normal[c] = (1 - s - t) * normals[c] + s * normals[3 + c] + t * normals[6 + c];
  const double length = norm(normal);
  return {normal[0] / length, normal[1] / length, normal[2] / length};
}

}  // namespace fdcg::test
