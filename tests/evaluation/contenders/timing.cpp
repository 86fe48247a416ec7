// SPDX-License-Identifier: Apache-2.0
#include "timing.hpp"

#include <algorithm>
#include <limits>

namespace fdcg::test {
namespace {

constexpr int kLeastRounds = 3, kMostRounds = 61;

double way_ns(Contender& contender, const Way& way, const Stopwatch& watch) {
  Feel feel;
  contender.reset();
  const std::uint64_t begin = Stopwatch::now();
  for (const auto& hip : way)
    contender.step(hip, feel);
  return watch.nanoseconds(begin, Stopwatch::now());
}

// A step's time by the contender's own clock, where it has one.
void time_ticks(Contender& contender, const Way& way, const Stopwatch& watch, std::vector<float>& least) {
  Feel feel;
  contender.reset();
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::uint64_t begin = Stopwatch::now();
    contender.step(way[i], feel);
    const std::uint64_t end = Stopwatch::now();
    const double own_ns = contender.own_ns();
    least[i] = std::min(least[i], static_cast<float>(own_ns < 0 ? watch.nanoseconds(begin, end) : own_ns));
  }
}

}  // namespace

double Timing::mean_ns() const {
  double sum = 0;
  for (const float ns : tick_ns)
    sum += ns;
  return sum / static_cast<double>(tick_ns.size());
}

std::vector<Timing> time_all(const std::vector<Contender*>& entrants, const Way& way, const Stopwatch& watch, double budget_s) {
  const double share_ns = budget_s * 1e9 / static_cast<double>(entrants.size());
  std::vector<Timing> timings(entrants.size());
  std::vector<int> wanted;
  for (std::size_t e = 0; e < entrants.size(); ++e) {
    double run_ns = way_ns(*entrants[e], way, watch);
    if (run_ns < share_ns / kLeastRounds)
      run_ns = std::min(run_ns, way_ns(*entrants[e], way, watch));               // one may be interrupted
    const double once_ns = 2 * run_ns + 60.0 * static_cast<double>(way.size());  // and the clock
    wanted.push_back(std::clamp(static_cast<int>(share_ns / once_ns), kLeastRounds, kMostRounds));
    timings[e].tick_ns.assign(way.size(), std::numeric_limits<float>::max());
    timings[e].batch_ns = std::numeric_limits<double>::max();
  }
  const int rounds = *std::max_element(wanted.begin(), wanted.end());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < entrants.size(); ++k) {
      const std::size_t e = (k + static_cast<std::size_t>(round)) % entrants.size();
      Timing& timing = timings[e];
      if (timing.rounds >= wanted[e]) continue;
      ++timing.rounds;
      timing.batch_ns = std::min(timing.batch_ns, way_ns(*entrants[e], way, watch) / static_cast<double>(way.size()));
      time_ticks(*entrants[e], way, watch, timing.tick_ns);
    }
  }
  return timings;
}

}  // namespace fdcg::test
