// SPDX-License-Identifier: Apache-2.0
// The part of an arrangement that bounds what is inside.
#pragma once

#include <cstdint>
#include <vector>

#include "solid/arrangement.hpp"

namespace fdcg::bake {

struct OuterFacets {
  bool is_closed = true;             // else there are no facets
  std::vector<Facet> facets;         // weight 1; corners are those of the arrangement; the front is outside
  std::vector<std::uint32_t> inner;  // sources of facets that were left out, ascending, each once, where no piece of it stays
};

// The facets between a winding number above 0, behind them, and one of 0 or less in front: the boundary of all that the surface
// encloses, without what lies within it. Patches, facets joined over edges of two, have one number on each side, which is
// counted along a ray from a point of the patch through `set`, whose arrangement it is, exactly. Where the facets are not
// closed there is no such number.
[[nodiscard]] OuterFacets outer_facets(const FacetSet& set, const Arrangement& arrangement);

}  // namespace fdcg::bake
