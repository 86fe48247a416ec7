// SPDX-License-Identifier: Apache-2.0
// Reading the section NODE_NORMALS.
#include "graph/node_normals.hpp"

#include "shared/octahedral.hpp"

namespace fdcg {

Vec3<double> normal_at_corner(const fdcg_node_normals& normals, uint32_t k, Vec3<double> normal) {
  if (k > 2 || is_flat_code(normals.corner[k])) return normal;
  const Vec3<double> found = octahedral_decoded(normals.corner[k]);
  if (!(dot(found, normal) >= kLeastLean)) return normal;
  return by_parts(found);
}

}  // namespace fdcg

extern "C" uint32_t fdcg_get_node_normals(const fdcg_graph* graph, uint32_t node, double normals[9]) {
  using namespace fdcg;
  const fdcg_node_info info = fdcg_get_node(graph, node);
  const Vec3<double> normal = vec(info.normal);
  const bool has_own = graph->normals != nullptr && info.side_count == 3 && !is_flat(graph->normals[node]);
  for (uint32_t k = 0; k < 3; ++k) {
    const Vec3<double> found = has_own ? normal_at_corner(graph->normals[node], k, normal) : normal;
    normals[3 * k] = found.x;
    normals[3 * k + 1] = found.y;
    normals[3 * k + 2] = found.z;
  }
  return has_own ? 1 : 0;
}
