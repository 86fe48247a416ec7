// SPDX-License-Identifier: Apache-2.0
#include "coulomb_load.hpp"

namespace fdcg::test {

CoulombLoad coulomb_load(const ReferenceSurface<Wide>& surface, std::uint32_t state, std::uint32_t feature,
                         const WidePoint& force, std::uint32_t edge_friction) {
  if (state == FDCG_FACE) {
    const WidePoint& n = surface.faces[feature].normal;
    const Wide pressing = dot(force, n);
    return {pressing, length(force - n * pressing), true};
  }
  if (state != FDCG_EDGE || surface.edges[feature].type != FDCG_CONCAVE) return {};
  const auto& edge = surface.edges[feature];
  const Wide along = dot(force, edge.direction);
  const WidePoint across = force - edge.direction * along;
  if (edge_friction == FDCG_EDGE_PAPER) return {length(across), std::abs(along), true};
  // across = load_a n_a + load_b n_b; with S = n_a + n_b the sum of the loads is 2 across.S / S.S.
  const WidePoint sum = surface.faces[edge.face[0]].normal + surface.faces[edge.face[1]].normal;
  return {2 * dot(across, sum) / dot(sum, sum), std::abs(along), true};
}

Wide off_the_slip(const ReferenceSurface<Wide>& surface, std::uint32_t state, std::uint32_t feature, const WidePoint& force,
                  const WidePoint& from, Wide load) {
  const auto along = [&](const WidePoint& v) {
    if (state == FDCG_EDGE) return surface.edges[feature].direction * dot(v, surface.edges[feature].direction);
    const WidePoint& n = surface.faces[feature].normal;
    return v - n * dot(v, n);
  };
  const WidePoint friction = along(force), slip = along(from);
  const Wide way = length(slip);
  return way > 0 ? length(friction - slip * (length(friction) / way)) / load : Wide(0);
}

}  // namespace fdcg::test
