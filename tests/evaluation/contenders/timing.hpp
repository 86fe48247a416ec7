// SPDX-License-Identifier: Apache-2.0
// What a step of each contender takes, measured alike.
#pragma once

#include <cstdint>
#include <vector>

#include "contender.hpp"
#include "stopwatch.hpp"
#include "ways.hpp"

namespace fdcg::test {

struct Timing {
  int rounds = 0;  // the same for all that are timed together
  // Warm: the way is stepped from end to end, each tick timed alone. Of every tick the median of the rounds: other work on the
  // machine is out of it, what the tick itself meets (its branches, what the rest of the way has left in the caches) is not.
  std::vector<float> tick_ns;
  [[nodiscard]] double mean_ns() const;    // of tick_ns
  double least_mean_ns = 0;                // of each tick's least
  double met_p999_ns = 0, met_max_ns = 0;  // over all ticks of all rounds as they were met, other work included
  double batch_ns = 0;                     // a tick, of the whole way timed at once, no clock within: the median of the rounds
  // Cold: of TimingPlan::cold_ticks, after the caches were swept before each; the median of three passes.
  std::vector<float> cold_ns;
};

struct TimingPlan {
  double budget_s = 0;                    // for all warm rounds together
  std::vector<std::uint32_t> cold_ticks;  // ascending; none: no cold pass
};

constexpr int kLeastRounds = 5, kMostRounds = 31;  // odd: a median is one of them

// Every entrant goes along the whole way in turn, round after round, on this thread, after one round that is not counted; each
// round begins with the next of them. All have the same number of rounds, as many as fit the budget. What reading the clock
// takes is taken off, as its median; a contender's own clock (Contender::own_ns) is taken as it is.
std::vector<Timing> time_all(const std::vector<Contender*>& entrants, const Way& way, const Stopwatch& watch,
                             const TimingPlan& plan);

// Instructions of a step, the median over three of `ticks`: the same on every run and machine of a kind. 0
// where they cannot be counted, are over a thousand, or are another process's.
double contact_instructions(Contender& contender, const Way& way, const std::vector<std::uint32_t>& ticks);

// What is taken off, beyond what two readings of the clock differ by at least.
double empty_step_ns(const Stopwatch& watch);

// Reads so many bytes, four times the second-level cache, a byte a line: what was in the first and second level is not any
// more. Code and what the processor predicts stay; so may much of the last level.
std::size_t swept_bytes();

}  // namespace fdcg::test
