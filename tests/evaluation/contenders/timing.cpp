// SPDX-License-Identifier: Apache-2.0
#include "timing.hpp"

#include <unistd.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "instruction_count.hpp"

namespace fdcg::test {
namespace {

constexpr std::size_t kLine = 64;
constexpr std::size_t kColdPasses = 3;

double median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Empty : public Contender {
 public:
  void reset() override {}
  void step(const Ground::Point& hip_m, Feel& feel) override { feel = {hip_m, {}, false, 0, false}; }
};

// A step's time, less that of a step which does nothing; or what the contender's own clock says.
class Clock {
 public:
  explicit Clock(const Stopwatch& watch) : watch_(watch) {
    Empty empty;
    Contender* volatile called = &empty;  // as all are: by a call that the compiler does not see through
    Feel feel;
    std::vector<float> readings(10'001);
    for (float& reading : readings)
      reading = step(*called, {}, feel);
    empty_ns_ = median(std::move(readings));
  }
  [[nodiscard]] double empty_ns() const { return empty_ns_; }
  float step(Contender& contender, const Ground::Point& hip_m, Feel& feel) const {
    const Ground::Point hip = hip_m;  // at hand, as it is to who has just computed it: every third of a way's is in a new line
    const std::uint64_t begin = Stopwatch::now();
    contender.step(hip, feel);
    const std::uint64_t end = Stopwatch::now();
    const double own_ns = contender.own_ns();
    return static_cast<float>(own_ns < 0 ? std::max(0.0, watch_.nanoseconds(begin, end) - empty_ns_) : own_ns);
  }
  double way(Contender& contender, const Way& way) const {
    Feel feel;
    contender.reset();
    const std::uint64_t begin = Stopwatch::now();
    for (const auto& hip : way)
      contender.step(hip, feel);
    return watch_.nanoseconds(begin, Stopwatch::now());
  }

 private:
  const Stopwatch& watch_;
  double empty_ns_ = 0;  // beyond the least of two readings, which the stopwatch takes off
};

void time_ticks(Contender& contender, const Way& way, const Clock& clock, float* ns) {
  Feel feel;
  contender.reset();
  for (std::size_t i = 0; i < way.size(); ++i)
    ns[i] = clock.step(contender, way[i], feel);
}

class Sweep {
 public:
  Sweep() : bytes_(swept_bytes(), 1) {}
  void operator()() {
    unsigned sum = 0;
    for (std::size_t i = 0; i < bytes_.size(); i += kLine)
      sum += bytes_[i];
    sink_ = sum;
  }

 private:
  std::vector<unsigned char> bytes_;
  volatile unsigned sink_ = 0;
};

void time_cold_once(Contender& contender, const Way& way, const std::vector<std::uint32_t>& ticks, const Clock& clock,
                    Sweep& sweep, float* ns) {
  Feel feel;
  contender.reset();
  for (std::size_t i = 0, next = 0; next < ticks.size(); ++i) {
    if (i < ticks[next]) {
      contender.step(way[i], feel);
      continue;
    }
    sweep();
    ns[next++] = clock.step(contender, way[i], feel);
  }
}

// Of each tick the median of a few passes.
std::vector<float> time_cold(Contender& contender, const Way& way, const std::vector<std::uint32_t>& ticks, const Clock& clock,
                             Sweep& sweep) {
  std::vector<std::vector<float>> passes(kColdPasses, std::vector<float>(ticks.size()));
  for (std::vector<float>& pass : passes)
    time_cold_once(contender, way, ticks, clock, sweep, pass.data());
  std::vector<float> ns, of_tick(passes.size());
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    for (std::size_t p = 0; p < passes.size(); ++p)
      of_tick[p] = passes[p][i];
    ns.push_back(static_cast<float>(median(of_tick)));
  }
  return ns;
}

// `met`: rounds times ticks.
void sum_up(const std::vector<float>& met, std::size_t ticks, Timing& timing) {
  const auto rounds = static_cast<std::size_t>(timing.rounds);
  std::vector<float> of_tick(rounds);
  for (std::size_t i = 0; i < ticks; ++i) {
    for (std::size_t r = 0; r < rounds; ++r)
      of_tick[r] = met[r * ticks + i];
    timing.tick_ns.push_back(static_cast<float>(median(of_tick)));
    timing.least_mean_ns += *std::min_element(of_tick.begin(), of_tick.end()) / static_cast<double>(ticks);
  }
  const Percentiles all(met);
  timing.met_p999_ns = all.at(0.999);
  timing.met_max_ns = all.at(1);
}

}  // namespace

double Timing::mean_ns() const {
  double sum = 0;
  for (const float ns : tick_ns)
    sum += ns;
  return sum / static_cast<double>(tick_ns.size());
}

std::size_t swept_bytes() {
  const long level_2 = sysconf(_SC_LEVEL2_CACHE_SIZE);
  constexpr std::size_t kNotKnown = std::size_t{1} << 20;
  return 4 * (level_2 > 0 ? static_cast<std::size_t>(level_2) : kNotKnown);
}

std::vector<Timing> time_all(const std::vector<Contender*>& entrants, const Way& way, const Stopwatch& watch,
                             const TimingPlan& plan) {
  const Clock clock(watch);
  const auto ticks = static_cast<double>(way.size());
  double round_ns = 0;
  for (Contender* entrant : entrants)
    round_ns += 2 * clock.way(*entrant, way) + 60 * ticks;  // and the clock; this is the round that is not counted
  const int fitting = std::clamp(static_cast<int>(plan.budget_s * 1e9 / round_ns), kLeastRounds, kMostRounds);
  const int rounds = fitting - 1 + fitting % 2;
  std::vector<Timing> timings(entrants.size());
  std::vector<std::vector<float>> met(entrants.size(), std::vector<float>(static_cast<std::size_t>(rounds) * way.size()));
  std::vector<std::vector<float>> batch(entrants.size());
  std::vector<std::size_t> order(entrants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 generator(1);
  for (int round = 0; round < rounds; ++round) {
    // Drawn anew: a contender that always follows one with the same code finds the processor's guesses made.
    std::shuffle(order.begin(), order.end(), generator);
    for (const std::size_t e : order) {
      batch[e].push_back(static_cast<float>(clock.way(*entrants[e], way) / ticks));
      time_ticks(*entrants[e], way, clock, met[e].data() + static_cast<std::size_t>(round) * way.size());
    }
  }
  Sweep sweep;
  for (std::size_t e = 0; e < entrants.size(); ++e) {
    timings[e].rounds = rounds;
    timings[e].batch_ns = median(batch[e]);
    sum_up(met[e], way.size(), timings[e]);
    timings[e].cold_ns = time_cold(*entrants[e], way, plan.cold_ticks, clock, sweep);
  }
  return timings;
}

double contact_instructions(Contender& contender, const Way& way, const std::vector<std::uint32_t>& ticks) {
  constexpr std::size_t kCounted = 3;
  constexpr std::uint64_t kMost = 1000;  // single-stepped, some ten microseconds each
  std::vector<float> counts;
  Feel feel;
  contender.reset();
  const std::size_t stride = std::max<std::size_t>(1, ticks.size() / kCounted);
  std::size_t long_ones = 0;
  for (std::size_t i = 0, next = stride / 2; next < ticks.size() && contender.own_ns() < 0; ++i) {
    if (i < ticks[next]) {
      contender.step(way[i], feel);
      continue;
    }
    counts.push_back(static_cast<float>(instructions_of([&] { contender.step(way[i], feel); }, kMost)));
    long_ones += counts.back() > 0.9 * kMost;
    if (2 * long_ones >= kCounted) return 0;
    next += stride;
  }
  return median(std::move(counts));
}

double empty_step_ns(const Stopwatch& watch) {
  return Clock(watch).empty_ns();
}

}  // namespace fdcg::test
