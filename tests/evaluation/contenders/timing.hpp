// SPDX-License-Identifier: Apache-2.0
// What a step of each contender takes, measured alike.
#pragma once

#include <vector>

#include "contender.hpp"
#include "stopwatch.hpp"
#include "ways.hpp"

namespace fdcg::test {

struct Timing {
  int rounds = 0;
  // Each tick timed alone, its least over the rounds. A tick is then as fast as this machine does it with what the rest of the
  // way has left in the cache, and other work on the machine is out of it.
  std::vector<float> tick_ns;
  [[nodiscard]] double mean_ns() const;  // of tick_ns
  double batch_ns = 0;                   // a tick, of the whole way timed at once: the least of the rounds. Checks the other
};

// Every entrant goes along the whole way in turn, round after round, on this thread, after one that is not counted; each round
// begins with the next of them. Each has as many rounds as fit its share of the budget, at least 3 and at most 61.
std::vector<Timing> time_all(const std::vector<Contender*>& entrants, const Way& way, const Stopwatch& watch, double budget_s);

}  // namespace fdcg::test
