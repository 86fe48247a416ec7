// SPDX-License-Identifier: Apache-2.0
// What the ticks of ways on several graphs cost, measured in turns, tick by tick, so that what else the machine does, and how
// fast its clock runs, falls on all of them alike.
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

// A contact on its way over a graph. The first point is where it starts; it is not timed.
struct Lane {
  const fdcg_graph* graph;
  const Path* path;
};

// The lanes' paths are of one length.
std::vector<StepTimes> time_steps(const std::vector<Lane>& lanes, const Stopwatch& watch, int replays);

}  // namespace fdcg::test
