// SPDX-License-Identifier: Apache-2.0
// Local minima of a body's support over the unit sphere.
#pragma once

#include "grasp/grasp_body.hpp"

namespace fdcg::grasp {

struct LocalMinimum {
  Vec6 direction{};  // unit
  double value = 0;  // the support there
};

// Monotonic descent from a unit direction.
LocalMinimum descend(const Body& body, const Vec6& from);

}  // namespace fdcg::grasp
