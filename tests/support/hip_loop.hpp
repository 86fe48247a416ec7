// SPDX-License-Identifier: Apache-2.0
// Closed loops of the HIP, and the energy that a hand gets out of one. With the force held between ticks the work done on the
// user is at most (docs/internals/contact-model.md#9-what-holds-of-every-tick)
//   sum over the intervals in contact of k |dx|^2 / 2  +  sum over the first contacts of k |GO - HIP|^2 / 2.
#pragma once

#include <cstddef>
#include <vector>

#include "contact_rig.hpp"
#include "random.hpp"

namespace fdcg::test {

struct LoopAccount {
  double work_j = 0;      // done on the user
  double bound_j = 0;     // the zero-order hold's term; intervals in free space add nothing to it
  double rounding_j = 0;  // what the stored energy may grow by: 16 eps of the extent, times the force, each tick in contact
  std::size_t contact_ticks = 0;
  bool is_closed = false;  // ends free: what the spring stored has been given back

  [[nodiscard]] bool has_touched() const { return contact_ticks > 0; }
};

// Steps a new contact along `hips` (object's frame, metres), of which the first and the last should be the same point outside.
// No damping.
LoopAccount account_of(const fdcg_graph& graph, const fdcg_params& params, const std::vector<Hip>& hips);

// An ellipse of `ticks` intervals through a body of this extent about the origin, that starts and ends outside.
std::vector<Hip> elliptic_loop(Random& random, double extent, int ticks);

}  // namespace fdcg::test
