// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_closed_loop: the largest stiffness at which a device pressed on a wall is stable, against rate, delay and the
// encoder's quantum, beside the lines of theory. See tests/evaluation/README.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include "linear_limit.hpp"
#include "parallel.hpp"
#include "program_options.hpp"
#include "random.hpp"
#include "table.hpp"
#include "wall_loop.hpp"

namespace fdcg::test {
namespace {

struct Options {
  bool is_quick = false;
  std::string output = ".";
  std::uint64_t seed = 1;
  unsigned threads = 2;
};

struct Device {
  const char* name;
  double mass_kg, damping_n_s_per_m;
};
constexpr Device kDevices[] = {{"light", 0.05, 0.2}, {"desktop", 0.1, 1}, {"heavy", 0.5, 8}};
constexpr double kRates_hz[] = {500, 1e3, 2e3, 4e3, 1e4, 2e4, 4e4};
constexpr double kHand_n_per_m = 400, kHand_n_s_per_m = 4;

// What counts as stable.
enum class Criterion {
  decays,        // no quantum: the late amplitude is not above the early one
  stays_small,   // with an encoder: the late swing is at most kMostQuanta from peak to peak
  comes_to_rest  // with dry friction as well: at most kRestQuanta
};
constexpr double kMostQuanta = 4, kRestQuanta = 0.01;
constexpr const char* kCriteria[] = {"decays", "stays small", "comes to rest"};

struct Case {
  Device device;
  bool is_held;
  LoopSetup setup;
  Criterion criterion;
};

// By bisection.
struct Limit {
  double stable_n_per_m, unstable_n_per_m;

  [[nodiscard]] double middle() const { return std::sqrt(stable_n_per_m * unstable_n_per_m); }
};

// A linear loop is let go 1/1000 of its depth off, and watched for many swings.
Watch linear_watch(const LoopSetup& setup, double wall_n_per_m) {
  constexpr double kSwings = 60, kLeastTicks = 4000, kMostTicks = 60000;
  const double swing_s = 2 * 3.141592653589793 * std::sqrt(setup.plant.mass_kg / wall_n_per_m);
  return {kPressed_m / 1000, 0, std::lround(std::clamp(kSwings * swing_s * setup.rate_hz, kLeastTicks, kMostTicks))};
}

// With an encoder it starts a quantum off, to see whether that grows; with dry friction, which hides small motions, a
// millimetre. It has many times its own time of decay to settle.
Watch quantised_watch(const Case& c, double offset) {
  constexpr double kTap_m = 1e-3, kDecays = 24;
  const double decay_s = 2 * c.setup.plant.mass_kg / c.setup.plant.damping_n_s_per_m;
  return {c.criterion == Criterion::comes_to_rest ? kTap_m : c.setup.quantum_m, offset,
          std::lround(kDecays * decay_s * c.setup.rate_hz)};
}

bool is_stable(const Wall& wall, const Case& c, double wall_n_per_m, std::uint64_t seed) {
  if (c.criterion == Criterion::decays) {
    constexpr double kGone = 1e-6;        // of the deviation: what is left then is rounding
    constexpr double kGrowth = 1 + 1e-5;  // the largest of the samples in a window is as good as that
    const Watch watch = linear_watch(c.setup, wall_n_per_m);
    const Seen seen = run_loop(wall, c.setup, wall_n_per_m, watch);
    return !seen.has_left_wall && (seen.late_m < kGrowth * seen.early_m || seen.late_m < kGone * watch.deviation_m);
  }
  constexpr int kOffsets = 3;  // of the encoder's steps: stable in each
  Random random(seed);
  const double quanta = c.criterion == Criterion::comes_to_rest ? kRestQuanta : kMostQuanta;
  for (int i = 0; i < kOffsets; ++i) {
    const Seen seen = run_loop(wall, c.setup, wall_n_per_m, quantised_watch(c, random.unit()));
    if (seen.has_left_wall || seen.late_swing_m > quanta * c.setup.quantum_m) return false;
  }
  return true;
}

// From a soft wall upwards to the first that is unstable, so that an island of instability is not jumped over, but for one
// narrower than a step; then by halves.
Limit find_limit(const Wall& wall, const Case& c, std::uint64_t seed) {
  constexpr double kSoftest_n_per_m = 5, kStiffest_n_per_m = 1e8, kFactor = 1.6;
  const double precision = c.criterion == Criterion::decays ? 1e-3 : 1e-2;
  Limit limit = {0, kSoftest_n_per_m};
  while (limit.unstable_n_per_m < kStiffest_n_per_m && is_stable(wall, c, limit.unstable_n_per_m, seed)) {
    limit.stable_n_per_m = limit.unstable_n_per_m;
    limit.unstable_n_per_m *= kFactor;
  }
  while (limit.stable_n_per_m > 0 && limit.unstable_n_per_m / limit.stable_n_per_m > 1 + precision)
    (is_stable(wall, c, limit.middle(), seed) ? limit.stable_n_per_m : limit.unstable_n_per_m) = limit.middle();
  return limit;
}

Plant plant_of(const Device& device, bool is_held, double coulomb_n) {
  return {device.mass_kg, device.damping_n_s_per_m + (is_held ? kHand_n_s_per_m : 0), is_held ? kHand_n_per_m : 0, coulomb_n};
}

std::vector<Case> all_cases(bool is_quick) {
  std::vector<Case> cases;
  for (const Device& device : kDevices) {
    for (const double rate : kRates_hz) {
      if (is_quick && rate != 1e3 && rate != 4e3) continue;
      for (const bool is_held : {false, true}) {
        for (int delay = 0; delay <= kMostDelay_ticks; ++delay)
          cases.push_back({device, is_held, {plant_of(device, is_held, 0), rate, delay, 0, 0}, Criterion::decays});
      }
      for (const double share : {0.25, 0.5, 0.75}) {
        const double damping = share * device.damping_n_s_per_m;
        cases.push_back({device, false, {plant_of(device, false, 0), rate, 0, damping, 0}, Criterion::decays});
      }
    }
  }
  const Device& device = kDevices[1];
  for (const double rate : kRates_hz) {
    if (rate > (is_quick ? 1e3 : 1e4)) continue;
    for (const double quantum : {1e-6, 1e-5, 5e-5}) {
      for (int delay = 0; delay <= 2; ++delay) {
        cases.push_back({device, false, {plant_of(device, false, 0), rate, delay, 0, quantum}, Criterion::stays_small});
        for (const double coulomb : {0.02, 0.2})
          cases.push_back(
              {device, false, {plant_of(device, false, coulomb), rate, delay, 0, quantum}, Criterion::comes_to_rest});
      }
    }
  }
  return cases;
}

// The device let go a little off its balance, below and above its limit.
void write_traces(const Wall& wall, const Options& options) {
  constexpr double kShares[] = {0.8, 0.98, 1.02, 1.2};
  constexpr long kTicks = 400;
  Table table(options.output, "closed_loop_traces", {"share_of_exact_limit", "time_s", "deviation_m"});
  const LoopSetup setup = {plant_of(kDevices[1], false, 0), 1000, 0, 0, 0};
  const double limit = exact_limit_n_per_m(setup);
  for (const double share : kShares) {
    std::vector<double> trace;
    run_loop(wall, setup, share * limit, {kPressed_m / 1000, 0, kTicks}, &trace);
    for (std::size_t k = 0; k < trace.size(); ++k)
      table.row(share, static_cast<double>(k + 1) * setup.tick_s(), trace[k]);
  }
}

struct Extremes {
  double off_exact = 0, over_line = std::numeric_limits<double>::infinity(), over_encoder_line = over_line;
  int compared = 0, against_line = 0, against_encoder_line = 0;
};

void say(const Case& c, const Limit& limit, Table* table, Extremes* extremes) {
  const LoopSetup& s = c.setup;
  const double b = c.device.damping_n_s_per_m, nan = std::nan("");
  const bool is_linear = c.criterion == Criterion::decays;
  const double exact = is_linear ? exact_limit_n_per_m(s) : nan;
  const double line = passivity_line_n_per_m(b, s), encoder = is_linear ? nan : encoder_line_n_per_m(b, s);
  table->row(c.device.name, c.device.mass_kg, b, c.is_held ? "held" : "none", s.rate_hz, s.delay_ticks, s.quantum_m,
             s.plant.coulomb_n, s.virtual_damping_n_s_per_m, kCriteria[static_cast<int>(c.criterion)], limit.middle(),
             limit.stable_n_per_m, limit.unstable_n_per_m, exact, line, encoder);
  if (is_linear) {
    extremes->off_exact = std::max(extremes->off_exact, std::abs(limit.middle() / exact - 1));
    ++extremes->compared;
    if (!std::isnan(line)) {
      extremes->over_line = std::min(extremes->over_line, limit.unstable_n_per_m / line);
      ++extremes->against_line;
    }
  }
  if (c.criterion == Criterion::comes_to_rest && encoder > 0) {
    extremes->over_encoder_line = std::min(extremes->over_encoder_line, limit.unstable_n_per_m / encoder);
    ++extremes->against_encoder_line;
  }
}

int run(const Options& options) {
  Bars bars(options.output, "fdcg_bench_closed_loop");
  const Wall wall(options.seed);
  const std::vector<Case> cases = all_cases(options.is_quick);
  std::vector<Limit> limits(cases.size());
  for_each_index(cases.size(), options.threads,
                 [&](std::size_t i) { limits[i] = find_limit(wall, cases[i], options.seed * 7919 + i); });
  Table table(options.output, "stability",
              {"device", "mass_kg", "damping_n_s_per_m", "hand", "rate_hz", "delay_ticks", "quantum_m", "coulomb_n",
               "virtual_damping_n_s_per_m", "criterion", "limit_n_per_m", "stable_n_per_m", "unstable_n_per_m", "exact_n_per_m",
               "passivity_line_n_per_m", "encoder_line_n_per_m"});
  Extremes e;
  for (std::size_t i = 0; i < cases.size(); ++i)
    say(cases[i], limits[i], &table, &e);
  write_traces(wall, options);
  bars.at_most("closed loop: simulated limit from the eigenvalues'", e.off_exact, 0.01, "",
               std::to_string(e.compared) + " loops without quantum; with and without a hand, delay, damping of the wall");
  bars.at_least("closed loop: least stiffness found unstable over the line b = K T / 2 + K T_d + |B|", e.over_line, 1, "",
                std::to_string(e.against_line) + " loops without quantum");
  bars.at_least("closed loop: least stiffness that does not come to rest over min(2 b / T, 2 c / quantum)", e.over_encoder_line,
                1, "", std::to_string(e.against_encoder_line) + " loops with encoder and dry friction");
  return bars.failures() > 0 ? 1 : 0;
}

}  // namespace
}  // namespace fdcg::test

int main(int argc, char** argv) {
  fdcg::test::Options options;
  fdcg::test::ProgramOptions program(
      "Finds the largest stable stiffness of a simulated device on a wall that fdcg_step renders.\n"
      "Example: fdcg_bench_closed_loop --quick --output closed_loop");
  program.flag("--quick", options.is_quick, "A few seconds: two rates");
  program.option("--output", options.output, "Folder for the tables");
  program.option("--seed", options.seed, "Of the wall's orientation and the encoder's steps");
  program.option("--threads", options.threads, "The results do not depend on it", 1, 256);
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    return fdcg::test::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fdcg_bench_closed_loop: %s\n", error.what());
    return 2;
  }
}
