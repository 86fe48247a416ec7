// SPDX-License-Identifier: Apache-2.0
// A surface that was made anew becomes the workpiece.
#pragma once

#include "repair/repair.hpp"
#include "solid/facets.hpp"

namespace fdcg::bake {

// The facets, ascending by their sources, which are faces of the input, take the place of all faces.
void take_over(Workpiece& piece, const FacetSet& set);

}  // namespace fdcg::bake
