// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "bench_graph.hpp"
#include "heap_count.hpp"
#include "random.hpp"
#include "scaling.hpp"
#include "scene_rig.hpp"
#include "slope.hpp"

namespace fdcg::test {
namespace {

constexpr int kParts = 7;              // 980 faces, all objects share the graph
constexpr double kSpacing_m = 0.3;     // of objects of 0.1 m, in a cube of rows
constexpr double kFlatExponent = 0.1;  // of what is promised not to depend on the number of objects
constexpr double kHandWay_m = 1e-4;

struct Crowd {
  int count, per_row;
  [[nodiscard]] Place home(int i) const {
    return {kSpacing_m * (i % per_row), kSpacing_m * (i / per_row % per_row), kSpacing_m * (i / per_row / per_row)};
  }
};

// What one finger, or the objects, do in the ticks of a case.
struct Case {
  const char* name;
  std::uint32_t disabled_optimizations;
  bool moves_objects;
  bool is_promised_flat;
  std::function<Place(const Crowd&, int tick)> hip;
};

std::vector<Case> cases(std::uint64_t seed) {
  const auto far = [](const Crowd&, int tick) { return Place{kHandWay_m * tick, -1, 0.5}; };
  const auto touch = [](const Crowd& crowd, int tick) {
    const Place middle = crowd.home(crowd.count / 2);
    const double angle = tick * kHandWay_m / kObject_m, radius = kObject_m / 2 + (tick < 2 ? 2e-3 : -1e-3);
    return Place{middle[0] + radius * std::cos(angle), middle[1] + radius * std::sin(angle), middle[2]};
  };
  const auto jump = [seed](const Crowd& crowd, int tick) {
    const double reach = kSpacing_m * crowd.per_row;
    const auto at = [&](std::uint64_t k) { return reach * hashed_unit(seed + k, static_cast<std::uint64_t>(tick)); };
    return Place{at(1), at(2), at(3)};
  };
  return {{"far", 0, false, true, far},
          {"look", FDCG_OPT_OUT_OF_REACH, false, false, far},
          {"touch", 0, false, true, touch},
          {"jump", 0, false, false, jump},
          {"all move", 0, true, false, far}};
}

struct Outcome {
  Percentiles least{{}};
  std::uint64_t heap_calls = 0, scene_bytes = 0;
  double touching = 0, add_ns = 0;  // share of the ticks; an object
};

// Each tick's least time of the replays: all of them are the same ticks.
Outcome run_case(const Case& what, const Crowd& crowd, const fdcg_graph& graph, int ticks, int replays,
                 const Stopwatch& watch) {
  Outcome outcome;
  fdcg_scene_config config = fdcg_make_scene_config();
  config.object_capacity = static_cast<std::uint32_t>(crowd.count);
  config.finger_capacity = 1;
  config.disabled_optimizations = what.disabled_optimizations;
  outcome.scene_bytes = fdcg_scene_bytes(&config);
  std::vector<float> least(static_cast<std::size_t>(ticks), 1e30F);
  for (int replay = 0; replay < replays; ++replay) {
    SceneRig scene(config);
    std::vector<fdcg_object_id> objects;
    objects.reserve(static_cast<std::size_t>(crowd.count));
    const std::uint64_t heap_before = heap_calls();
    const std::uint64_t add_begin = Stopwatch::now();
    for (int i = 0; i < crowd.count; ++i)
      objects.push_back(scene.add(graph, fdcg_make_params(), posed(crowd.home(i))));
    const double add_ns = watch.nanoseconds(add_begin, Stopwatch::now()) / crowd.count;
    outcome.add_ns = replay == 0 ? add_ns : std::min(outcome.add_ns, add_ns);
    const fdcg_finger_id finger = scene.add(what.hip(crowd, 0));
    for (int tick = 0; tick < ticks; ++tick) {
      for (int i = 0; what.moves_objects && i < crowd.count; ++i) {
        const Place home = crowd.home(i);
        scene.pose(objects[static_cast<std::size_t>(i)],
                   posed({home[0], home[1], home[2] + 1e-5 * (tick % 2)}, {0, 0, 1}, 1e-3 * tick));
      }
      scene.move(finger, what.hip(crowd, tick));
      const std::uint64_t begin = Stopwatch::now();
      scene.step();
      auto& best = least[static_cast<std::size_t>(tick)];
      best = std::min(best, static_cast<float>(watch.nanoseconds(begin, Stopwatch::now())));
      if (replay == 0) outcome.touching += scene.result(finger).touch_count > 0;
    }
    outcome.heap_calls += heap_calls() - heap_before;
  }
  outcome.touching /= ticks;
  outcome.least = Percentiles(std::move(least));
  return outcome;
}

}  // namespace

void scale_objects(const ScalingRun& run) {
  constexpr int kObjectTicks = 400'000, kFewestTicks = 40, kMostTicks = 500;
  const int most = run.is_quick ? 1000 : 10'000, replays = run.is_quick ? 3 : 7;
  Table table(
      run.output, "scaling_objects",
      {"case", "objects", "scene_bytes", "add_an_object_ns", "step_p50_ns", "step_p99_ns", "step_max_ns", "touching_share"});
  const BenchGraph graph(make_body(Body::sphere, kParts), {});
  std::printf("\n%-9s %8s %12s %12s %10s\n", "case", "objects", "step p50 ns", "max ns", "touching");
  std::uint64_t heap = 0;
  for (const Case& what : cases(run.seed)) {
    Series series;
    for (int count = 1; count <= most; count *= 10) {
      const Crowd crowd = {count, std::max(1, static_cast<int>(std::ceil(std::cbrt(count) - 1e-9)))};
      const int ticks = std::clamp(kObjectTicks / count, kFewestTicks, kMostTicks);
      const Outcome out = run_case(what, crowd, graph.view(), ticks, replays, run.watch);
      table.row(what.name, count, out.scene_bytes, out.add_ns, out.least.at(0.5), out.least.at(0.99), out.least.at(1),
                out.touching);
      std::printf("%-9s %8d %12.1f %12.1f %9.0f%%\n", what.name, count, out.least.at(0.5), out.least.at(1), 100 * out.touching);
      series.emplace_back(count, out.least.at(0.5));
      heap += out.heap_calls;
    }
    const double exponent = exponent_of(series);
    run.exponents->row("scaling_objects", "sphere", "f64", "stored", std::string("step_p50_ns, ") + what.name, 1,
                       series.back().first, exponent);
    std::printf("exponent %6.3f  step by objects, %s\n", exponent, what.name);
    if (what.is_promised_flat)
      judge_time(run, std::string("exponent of a finger's step by objects, ") + what.name, exponent, kFlatExponent, "");
  }
  if (can_count_heap_calls()) run.bars->at_most("heap calls while stepping scenes", static_cast<double>(heap), 0, "");
}

}  // namespace fdcg::test
