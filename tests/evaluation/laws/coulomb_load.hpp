// SPDX-License-Identifier: Apache-2.0
// What a force means to Coulomb's law on the feature that bears it, from the corners that the file stores and in long double:
// the runtime's planes are not asked.
#pragma once

#include "contact_rig.hpp"
#include "reference_surface.hpp"

namespace fdcg::test {

using Wide = long double;
using WidePoint = Vector<Wide>;

inline WidePoint wide(const double (&p)[3]) {
  return {p[0], p[1], p[2]};
}

// `normal`: what presses; `tangential`: what friction bears. On a face the parts along and across its normal. On a concave edge
// the part along the edge, and the sum of the two loads that the walls bear (wedge) or the length of what lies across the edge
// (paper). is_borne is false on every other feature: a convex edge, a vertex and free space bear no load by these rules.
struct CoulombLoad {
  Wide normal = 0, tangential = 0;
  bool is_borne = false;

  [[nodiscard]] Wide ratio() const { return tangential / normal; }
};

CoulombLoad coulomb_load(const ReferenceSurface<Wide>& surface, std::uint32_t state, std::uint32_t feature,
                         const WidePoint& force, std::uint32_t edge_friction);

// How far the friction on a face or a concave edge is from lying along the slip, as a share of the load that presses: from
// where the god-object stood it goes straight to where it presses less, whatever seams are in the way. `from`: the HIP to where
// it stood.
Wide off_the_slip(const ReferenceSurface<Wide>& surface, std::uint32_t state, std::uint32_t feature, const WidePoint& force,
                  const WidePoint& from, Wide load);

}  // namespace fdcg::test
