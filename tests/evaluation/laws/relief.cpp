// SPDX-License-Identifier: Apache-2.0
// What is felt of heights on a flat face: a HIP strokes ridges, grain and an image of ridges without friction, and the
// vibration of its force is compared with the formula's, and its time with that of the step alone.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include "band.hpp"
#include "fdcg/heights.h"
#include "laws.hpp"
#include "meshes.hpp"
#include "pressed.hpp"

namespace fdcg::test {
namespace {

constexpr double kSide_m = 0.2, kDepth_m = 1.5e-3, kSpeed_m_per_s = 0.1, kRate_hz = 1000, kStiffness_n_per_m = 1000;
constexpr double kHeight_m = 1e-4, kWave_m = 1e-3;
constexpr double kLow_hz = 80, kHigh_hz = 450;  // where skin feels best
constexpr int kEntryTicks = 50, kTexels = 16;

// A block with an image of one wave on it, again and again along x.
bake::PolygonSoup block() {
  bake::PolygonSoup soup = scaled(cube(), kSide_m);
  bake::HeightImage image;
  image.name = "wave";
  image.width = kTexels, image.height = 1, image.range = 2 * kHeight_m;
  for (int i = 0; i < kTexels; ++i)
    image.values.push_back(static_cast<float>(0.5 + 0.5 * std::sin(2 * kPi * (i + 0.5) / kTexels)));
  soup.appearance.images = {image};
  soup.appearance.all_heights = 0;
  for (const std::uint32_t corner : soup.corners) {
    const bake::Vec3& p = soup.points[corner];
    soup.appearance.uv.push_back({static_cast<float>(p.x / kWave_m), static_cast<float>((p.y + p.z) / kWave_m)});
  }
  return soup;
}

Hip hip_at(int tick) {
  const double above = tick == 0 ? 1e-3 : -kDepth_m;
  return {-0.3 * kSide_m + tick * kSpeed_m_per_s / kRate_hz, 0.1 * kSide_m, 0.5 * kSide_m + above};
}

struct Stroked {
  const fdcg_graph* graph;
  const fdcg_relief* relief;  // null: the step alone
  Pressed pressed{graph};
  fdcg_relief_state state{};

  explicit Stroked(const fdcg_graph& on, const fdcg_relief* of) : graph(&on), relief(of) {}

  const fdcg_result& step(const fdcg_params& params, const Hip& hip) {
    if (relief == nullptr) return pressed.step(params, hip);
    double moved_m[3];
    fdcg_effect_facts facts;
    fdcg_relief_move(relief, &state, hip.data(), params.tick_s, moved_m);
    pressed.step(params, {moved_m[0], moved_m[1], moved_m[2]});
    if (fdcg_get_effect_facts(graph, &pressed.result, moved_m, 0, params.tick_s, &facts, nullptr) == FDCG_OK)
      fdcg_relief_turn(relief, &state, &facts, pressed.result.force_n);
    return pressed.result;
  }
};

// k (depth + height) along the normal, and that times the slope against it.
Hip by_formula(const fdcg_waves& waves, const Hip& hip) {
  double height = 0;
  std::array<double, 2> slope{};
  for (std::uint32_t i = 0; i < waves.count; ++i) {
    const double* const per_m = waves.per_m[i];
    const double turns = per_m[0] * hip[0] + per_m[1] * hip[1] + per_m[2] * 0.5 * kSide_m + waves.phase_turns[i];
    height += waves.amplitude_m[i] * std::sin(2 * kPi * turns);
    for (std::size_t k = 0; k < 2; ++k)
      slope[k] += waves.amplitude_m[i] * 2 * kPi * per_m[k] * std::cos(2 * kPi * turns);
  }
  const double load_n = kStiffness_n_per_m * (kDepth_m + height);
  return {-load_n * slope[0], -load_n * slope[1], load_n};
}

double vibration_n(const std::vector<Hip>& forces) {
  double power = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> component;
    for (const Hip& force : forces)
      component.push_back(force[c]);
    power += band_power(component, kRate_hz, kLow_hz, kHigh_hz);
  }
  return std::sqrt(power);
}

// The least of some rounds, so that what else the machine does counts little.
double time_of_tick_ns(const fdcg_graph& graph, const fdcg_params& params, const fdcg_relief* relief) {
  constexpr int kRounds = 30, kTicks = 1000;
  std::vector<Hip> hips;
  for (int tick = 0; tick < kTicks; ++tick)
    hips.push_back(hip_at(tick));
  double least = 1e300;
  for (int round = 0; round < kRounds; ++round) {
    Stroked stroked(graph, relief);
    const auto begin = std::chrono::steady_clock::now();
    for (const Hip& hip : hips)
      stroked.step(params, hip);
    least =
        std::min(least, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count() / kTicks);
  }
  return least;
}

}  // namespace

void measure_relief(const LawOptions& options, Bars& bars) {
  constexpr double kAlongX[3] = {1, 0, 0};
  const int ticks = options.is_quick ? 400 : 1000;
  bake::CompileOptions compile;
  compile.heights = true;
  compile.jobs = 1;
  const CompiledMesh mesh(block(), compile);
  fdcg_params params = contact_params(0, 0);
  params.stiffness_n_per_m = kStiffness_n_per_m;
  // an image of 0 to 1 begins where its coordinate is whole: with the wave
  const fdcg_waves ridges = fdcg_make_ridges(kHeight_m, kWave_m, kAlongX), grain = fdcg_make_grain(2e-5, 1e-3, 1e-2, 1, 1);
  fdcg_heights heights{};
  fdcg_get_heights(&mesh.view(), &heights, nullptr);
  struct Row {
    const char* name;
    fdcg_relief relief;
    const fdcg_waves* formula;
  };
  const Row rows[] = {{"ridges", fdcg_make_relief(&ridges), &ridges},
                      {"grain", fdcg_make_relief(&grain), &grain},
                      {"image of ridges", fdcg_make_height_relief(&heights), &ridges}};
  Table table(options.output, "relief", {"heights", "vibration_mn", "formula_mn", "tick_ns", "step_ns"});
  double worst = 0;
  const double step_ns = time_of_tick_ns(mesh.view(), params, nullptr);
  for (const Row& row : rows) {
    Stroked stroked(mesh.view(), &row.relief);
    std::vector<Hip> felt, expected;
    for (int tick = 0; tick < ticks + kEntryTicks; ++tick) {
      const Hip hip = hip_at(tick);
      const fdcg_result& result = stroked.step(params, hip);
      if (tick < kEntryTicks) continue;
      felt.push_back({result.force_n[0], result.force_n[1], result.force_n[2]});
      expected.push_back(by_formula(*row.formula, hip));
    }
    const double is_n = vibration_n(felt), should_n = vibration_n(expected);
    worst = std::max(worst, std::fabs(is_n / should_n - 1));
    const double tick_ns = time_of_tick_ns(mesh.view(), params, &row.relief);
    table.row(row.name, is_n * 1e3, should_n * 1e3, tick_ns, step_ns);
  }
  bars.at_most("relief: vibration of 80 to 450 Hz, off the formula's by", worst, 0.01, "",
               "ridges, grain and an image of ridges at 0.1 m/s and 1.5 N");
}

}  // namespace fdcg::test
