// SPDX-License-Identifier: Apache-2.0
// The least support of a body over all unit directions, by branch and bound over cones of directions.
#pragma once

#include <cstdint>

#include "fdcg/bake.hpp"
#include "grasp/grasp_body.hpp"
#include "grasp/grasp_minimum.hpp"

namespace fdcg::grasp {

struct LeastSupport {
  LocalMinimum best;
  double lower = 0;  // proved lower bound over all directions
  std::uint64_t cells = 0;
};

// start: a direction known to have low support. Stops when the bounds are within kTolerance / 2, when the least support is at
// most kTolerance, and after max_cells cones.
LeastSupport least_support(const Body& body, const LocalMinimum& start, std::uint64_t max_cells,
                           const bake::Progress& progress = {});

}  // namespace fdcg::grasp
