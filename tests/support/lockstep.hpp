// SPDX-License-Identifier: Apache-2.0
// Runtime and reference, each with its own contact, over one walk.
#pragma once

#include <cstdint>
#include <string>

#include "contact_rig.hpp"
#include "fdcg/fdcg.h"
#include "hip_walk.hpp"
#include "reference_walker.hpp"

namespace fdcg::test {

struct Lockstep {
  std::uint64_t steps = 0, contact_steps = 0, transitions = 0;
  // Steps after which the two differ (a tie counts once for as long as the HIP is held still and the contact rests):
  std::uint64_t drifts = 0;  // repeated with 150 digits from the runtime's own contact, the reference agrees with the runtime
  std::uint64_t slip_ties = 0;          // a decision was within rounding; only the slip flag differs
  std::uint64_t ties = 0;               // a decision was within rounding
  std::uint64_t ties_off_features = 0;  // of those, where neither this HIP nor the last was put exactly on a feature
  std::uint64_t steps_off_features = 0;
  std::uint64_t failures = 0;          // all others
  std::uint64_t bound_hits = 0;        // steps that carried work over to the next tick
  std::uint64_t most_transitions = 0;  // of the reference in one step
  double worst_god_object = 0;         // largest difference while they agree, parts of the extent
  double worst_growth = 0;             // largest growth of |GO - HIP| within a step, parts of eps of the extent
  std::string first_growth;            // the first beyond 16 eps
  std::string first_failure;           // everything needed to repeat it
};

// `soup` in the graph's object frame at one metre per unit: the walk is drawn from its points.
Lockstep run_lockstep(const fdcg_graph& graph, const bake::PolygonSoup& soup, const fdcg_params& params, std::uint64_t steps,
                      std::uint64_t seed);

// FDCG_STEPS, or the default.
std::uint64_t step_count(std::uint64_t by_default);

}  // namespace fdcg::test
