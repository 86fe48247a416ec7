// SPDX-License-Identifier: Apache-2.0
// fdcg_bench_hands: every contender in a loop with a simulated device of three axes that a hand holds: the force that reaches
// the hand beside the truth's, and how stiff a contact may be before it shakes. See tests/evaluation/README.md.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "hand_metrics.hpp"
#include "hand_scenes.hpp"
#include "linear_limit.hpp"
#include "plan.hpp"
#include "point.hpp"
#include "program_options.hpp"
#include "table.hpp"

namespace fdcg::test {
namespace {

struct Options {
  bool is_quick = false;
  std::string output = ".";
  std::uint64_t seed = 1;
  std::vector<std::string> rivals;
};

// Drawn; the truth is too. In quick runs they alone are held.
constexpr const char* kTraced[] = {"truth",     "fdcg_f64_stored", "paper",       "embree_closest",
                                   "ray_proxy", "grid_64",         "finger_proxy"};
constexpr std::size_t kTracedTicks = 3;  // one of so many

// The worst of this project's contenders.
struct Own {
  double f64_n = 0, f32_n = 0, swing_m = 0, off_exact = 0, lost = 0;
  std::string f64_at, f32_at, swing_at, exact_at, lost_at;
};
void worsen(double value, const std::string& where, double* worst, std::string* at) {
  if (value > *worst) *worst = value, *at = where;
}

Contenders contenders_on(const Ground& ground, const std::string& name, const Options& options) {
  Body body;
  body.name = name;
  body.faces = static_cast<std::uint32_t>(ground.soup().face_count());
  return all_contenders_for(ground, body, options.is_quick, options.rivals);
}

bool is_traced(const std::string& name) {
  return std::ranges::find(kTraced, name) != std::end(kTraced);
}

void trace(const HandScene& scene, const std::string& name, const HandSetup& setup, const std::vector<HandTick>& ticks,
           const std::vector<HandTick>& truth, Table* table) {
  using namespace plain;
  if (!is_traced(name)) return;
  for (std::size_t i = 0; i < ticks.size(); i += kTracedTicks)
    table->row(scene.name, name, static_cast<double>(i) / setup.rate_hz, length(ticks[i].hand_n),
               length(ticks[i].hand_n - truth[i].hand_n));
}

void measure_scene(const HandScene& scene, const HandSetup& setup, const Options& options, Table* table, Table* traces,
                   Own* own) {
  const Ground ground(scene.soup);
  const auto truth_of = make_truth(scene.soup);
  truth_of->set_friction(scene.mu_static, scene.mu_dynamic);
  const std::vector<HandTick> truth = run_hand(*truth_of, scene.targets_m, setup);
  trace(scene, "truth", setup, truth, truth, traces);
  for (const auto& contender : contenders_on(ground, scene.name, options)) {
    const ContenderInfo& info = contender->info();
    contender->set_friction(scene.mu_static, scene.mu_dynamic);
    if (scene.mu_static > 0 && !info.has_friction) continue;
    const std::vector<HandTick> ticks = run_hand(*contender, scene.targets_m, setup);
    const HandMetrics m = judge_hand(ticks, truth, setup.rate_hz, scene.held_from, scene.held_to);
    table->row(scene.name, scene.what, scene.mu_static, scene.mu_dynamic, info.name, info.family, info.precision, ticks.size(),
               m.rms_n, m.max_n, m.vibration_n, m.true_vibration_n, m.direction_p99_deg, m.felt_share, m.felt_ms, m.apart_m,
               m.lost_share, m.held_swing_m, m.gained_j, m.true_gained_j);
    trace(scene, info.name, setup, ticks, truth, traces);
    if (info.family != "fdcg") continue;
    const std::string where = info.name + ", " + scene.name;
    if (info.precision == "f64") worsen(m.max_n, where, &own->f64_n, &own->f64_at);
    if (info.precision == "f32") worsen(m.max_n, where, &own->f32_n, &own->f32_at);
    worsen(m.held_swing_m, where, &own->swing_m, &own->swing_at);
    worsen(m.lost_share, where, &own->lost, &own->lost_at);
  }
  std::printf("%s: %s\n", scene.name.c_str(), scene.what.c_str());
  std::fflush(stdout);
}

void measure_hold(const HoldScene& scene, const HandSetup& setup, const Options& options, Table* table, Own* own) {
  const Ground ground(scene.soup);
  const double exact = exact_limit_n_per_m({setup.axis(), setup.rate_hz, 0, 0, 0});
  for (const auto& contender : contenders_on(ground, scene.name, options)) {
    const ContenderInfo& info = contender->info();
    if (options.is_quick && !is_traced(info.name)) continue;
    contender->set_friction(0, 0);
    const double share = stable_share(*contender, scene.hold, setup, exact);
    table->row(scene.name, info.name, info.family, info.precision, share, exact);
    if (info.family == "fdcg") worsen(std::abs(share - 1), info.name + ", " + scene.name, &own->off_exact, &own->exact_at);
  }
  std::printf("held: %s\n", scene.name.c_str());
  std::fflush(stdout);
}

int run(const Options& options) {
  const HandSetup setup;
  Own own;
  Table table(options.output, "hands", {"scene",
                                        "what",
                                        "mu_static",
                                        "mu_dynamic",
                                        "contender",
                                        "family",
                                        "precision",
                                        "ticks",
                                        "hand_rms_n",
                                        "hand_max_n",
                                        "vibration_n",
                                        "true_vibration_n",
                                        "direction_p99_deg",
                                        "felt_share",
                                        "felt_ms",
                                        "apart_m",
                                        "lost_share",
                                        "held_swing_m",
                                        "gained_j",
                                        "true_gained_j"});
  Table traces(options.output, "hands_traces", {"scene", "contender", "time_s", "hand_n", "off_n"});
  Table limits(options.output, "hands_limits",
               {"scene", "contender", "family", "precision", "stable_share_of_exact", "exact_n_per_m"});
  for (const HandScene& scene : hand_scenes(setup.rate_hz)) {
    if (!options.is_quick || scene.name == "edge" || scene.name == "groove_rubbed")
      measure_scene(scene, setup, options, &table, &traces, &own);
  }
  for (const HoldScene& scene : hold_scenes()) {
    if (!options.is_quick || scene.name == "corner") measure_hold(scene, setup, options, &limits, &own);
  }
  Bars bars(options.output, "fdcg_bench_hands");
  bars.at_most("hands: own force at the hand from the truth's, f64", own.f64_n, 1e-9, "N", own.f64_at);
  bars.at_most("hands: own force at the hand from the truth's, f32", own.f32_n, 1e-3, "N", own.f32_at);
  bars.at_most("hands: own device's swing under a hand that holds still", own.swing_m, 1e-5, "m", own.swing_at);
  bars.at_most("hands: own contact lost", own.lost, 0.001, "of the truth's ticks", own.lost_at);
  bars.at_most("hands: own stiffest stable contact from one axis' eigenvalues'", own.off_exact, 0.01, "", own.exact_at);
  return bars.failures() > 0 ? 1 : 0;
}

}  // namespace
}  // namespace fdcg::test

int main(int argc, char** argv) {
  fdcg::test::Options options;
  fdcg::test::ProgramOptions program(
      "Every contender in a loop with a simulated device of three axes that a hand holds: over edges, in grooves and corners,\n"
      "on facets and a thin plate, with friction and without. Writes hands.csv, hands_traces.csv and hands_limits.csv.\n"
      "Example: fdcg_bench_hands --quick --output hands");
  program.flag("--quick", options.is_quick, "A few seconds: two ways, one hold");
  program.option("--output", options.output, "Folder for the tables");
  program.option("--seed", options.seed, "Of nothing here: nothing is drawn at random");
  program.option("--rival", options.rivals, "shared object or pipe:COMMAND that takes part too (docs/rivals.md)");
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    return fdcg::test::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fdcg_bench_hands: %s\n", error.what());
    return 2;
  }
}
