// SPDX-License-Identifier: Apache-2.0
// What a hand is owed on a solid body: a force in every tick that it is inside. Decided from the source mesh alone, by exact
// signs.
#pragma once

#include <cstdint>
#include <vector>

#include "exact_solid.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::test {

struct HandReport {
  std::uint64_t ticks = 0, contact_ticks = 0, carried_ticks = 0;
  std::uint64_t forceless_ticks = 0, longest_forceless = 0;  // inside, though it has been outside; the longest run of such
  double deepest_forceless_m = 0;
  double worst_first_force = 0;  // of a contact's first tick: the force over that of a spring as long as the tick's way
  double worst_ns = 0;           // of a tick, by the clock

  void add(const HandReport& other);
};

// Steps a new contact along the HIPs (metres, the object's frame). As long as they have not been outside, nothing is owed.
HandReport probe_hand(const fdcg_graph& graph, const ExactSolid& solid, const fdcg_params& params,
                      const std::vector<Hip>& way_m);

}  // namespace fdcg::test
