// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>

#include "validate/check_rules.hpp"

namespace fdcg::bake::checks {

void non_finite_coordinate(const Subject& subject, Findings& out) {
  for (std::uint32_t v = 0; v < subject.mesh.points.size(); ++v) {
    const Vec3& p = subject.mesh.points[v];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) out.at_vertex(subject.mesh.source_point[v]);
  }
}

void non_manifold_vertex(const Subject& subject, Findings& out) {
  for (const VertexId v : vertices_of_several_fans(subject.mesh, subject.topology, subject.states))
    out.at_vertex(subject.mesh.source_point[+v]);
}

void isolated_vertex(const Subject& subject, Findings& out) {
  std::vector<bool> is_used(subject.mesh.points.size(), false);
  for (const VertexId v : subject.mesh.corners) {
    if (v != VertexId{kNone}) is_used[+v] = true;
  }
  for (std::uint32_t v = 0; v < is_used.size(); ++v) {
    if (!is_used[v]) out.at_vertex(subject.mesh.source_point[v]);
  }
}

void duplicate_vertex(const Subject& subject, Findings& out) {
  // The vertices that were kept are in ascending order: all between two of them were joined to others.
  const std::vector<std::uint32_t>& standing = subject.mesh.source_point;
  std::uint32_t source = 0;
  for (std::size_t v = 0; v <= standing.size(); ++v, ++source) {
    const std::size_t stop = v < standing.size() ? standing[v] : subject.soup.points.size();
    for (; source < stop; ++source)
      out.at_vertex(source);
  }
}

}  // namespace fdcg::bake::checks
