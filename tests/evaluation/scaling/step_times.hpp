// SPDX-License-Identifier: Apache-2.0
// What the ticks of a way cost on several graphs of one body, measured in turns so that what else the machine does falls on all
// of them alike.
#pragma once

#include <cstdint>
#include <vector>

#include "bench_graph.hpp"
#include "fdcg/fdcg.h"
#include "stopwatch.hpp"

namespace fdcg::test {

struct StepTimes {
  Percentiles met{{}};  // ns: one tick, timed alone, as the way meets it: new faces are not in the cache
  Percentiles own{{}};  // ns: the same tick again from a copy of the contact, the least of the replays: the step's own work
  double own_mean_ns = 0;
  double transitions = 0, contact = 0;  // changes of state a tick; share of ticks in contact
  std::uint64_t heap_calls = 0;         // while stepping
  std::uint64_t bounded_ticks = 0;      // that carried work over
};

// Steps one contact on each graph along the path. The first point is where it starts; it is not timed.
std::vector<StepTimes> time_steps(const std::vector<const fdcg_graph*>& graphs, const Path& path, const Stopwatch& watch,
                                  int replays);

}  // namespace fdcg::test
