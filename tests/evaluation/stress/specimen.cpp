// SPDX-License-Identifier: Apache-2.0
#include "specimen.hpp"

#include <limits>
#include <utility>

#include "exact_solid.hpp"
#include "meshes.hpp"

namespace fdcg::test {

Specimen::Specimen(Body b) : body(std::move(b)), mesh(body.soup, body.options) {
  read_shapes();
  find_focus();
  if (!body.is_closed) return;
  const ExactSolid solid(triangulated(body.soup), header());
  inside = std::make_unique<InsideGrid>(solid.triangles());
  descent = std::make_unique<Descent>(solid.triangles());
}

void Specimen::read_shapes() {
  const fdcg_graph& g = graph();
  for (std::uint32_t n = 0; n < header().node_count; ++n) {
    const fdcg_node_info node = fdcg_get_node(&g, n);
    nodes.push_back({hip_of(node.normal), node.offset, static_cast<std::uint32_t>(rims.size()), node.side_count});
    for (std::uint32_t k = 0; k < node.side_count; ++k) {
      const fdcg_side_info side = fdcg_get_side(&g, n, k);
      rims.push_back({hip_of(side.voronoi_normal), side.voronoi_offset});
    }
  }
  for (std::uint32_t c = 0; c < header().corner_count; ++c) {
    const fdcg_corner_info corner = fdcg_get_corner(&g, c);
    corners.push_back({hip_of(corner.point), hip_of(corner.normal)});
  }
  for (std::uint32_t e = 0; e < header().connection_count; ++e) {
    const fdcg_connection_info c = fdcg_get_connection(&g, e);
    edges.push_back({corners[c.corner[0]].point, hip_of(c.direction), c.length, c.type, {c.node[0], c.node[1]}});
  }
}

void Specimen::find_focus() {
  for (const std::uint32_t v : body.focus) {
    const bake::Vec3& p = body.soup.points[v];
    const double* origin = header().origin;
    const Hip local = {p.x - origin[0], p.y - origin[1], p.z - origin[2]};
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t corner = 0;
    for (std::uint32_t c = 0; c < corners.size(); ++c) {
      const double d = distance(corners[c].point, local);
      if (d < nearest) nearest = d, corner = c;
    }
    focus_corners.push_back(corner);
  }
}

}  // namespace fdcg::test
