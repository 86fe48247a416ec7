// SPDX-License-Identifier: Apache-2.0
// What a scene's tick costs, and what each thing that is skipped saves: in nanoseconds, in bytes, with the forces compared bit
// for bit in the same run. One file, since the scenes, the switches and the table are one experiment.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "bench_graph.hpp"
#include "heap_count.hpp"
#include "meshes.hpp"
#include "scene_rig.hpp"
#include "stopwatch.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::PolygonSoup;

namespace {

// Faces: more without a hierarchy are more than a step's sweep may look at, and the rest is carried over to the next tick.
constexpr std::size_t kMostWithoutHierarchy = 500;
constexpr double kTick_s = 0.001, kTurn = 2 * std::numbers::pi;

// ---- scenes
// ------------------------------------------------------------------------------------------------------------------

struct Actor {
  Place home;
  double phase;
  int kind;
};

// Who is there, and where everything is in a tick. Everything is a function of the tick, so that every run is the same.
struct Script {
  const char* name;
  std::vector<PolygonSoup> bodies;  // objects take them in turn
  std::vector<Actor> objects, fingers;
  std::function<bool(const Actor&, int, fdcg_pose*)> pose;  // false: it has not moved
  std::function<Place(const Actor&, int)> hip;
  std::uint32_t touches_per_finger;
  int ticks;
};

PolygonSoup stretched(PolygonSoup soup, double x, double y, double z) {
  for (auto& p : soup.points)
    p = {p.x * x, p.y * y, p.z * z};
  return soup;
}

// Slides over an object of 82 thousand faces, lifts off, goes half a metre away and comes back.
Script one_finger() {
  Script script = {"finger", {scaled(star_sphere(6, 0.1, 3), 0.05)}, {{{0, 0, 0}, 0, 0}}, {{{0, 0, 0}, 0, 0}}, {}, {}, 4, 4000};
  script.pose = [](const Actor&, int, fdcg_pose*) { return false; };
  script.hip = [](const Actor&, int tick) {
    const double a = 0.002 * tick, cycle = std::sin(kTurn * tick / 2000.0);
    const double radius = 0.049 + (cycle > 0 ? 0 : -0.5 * cycle);
    return Place{radius * std::cos(a), radius * std::sin(a) * 0.8, radius * std::sin(a) * 0.6};
  };
  return script;
}

// A hundred instruments of 20 cm on a tray, two of them in use; three fingers go from one to the next.
Script tray() {
  Script script = {
      "tray",
      {stretched(scaled(star_sphere(2, 0.1, 3), 0.05), 2, 0.15, 0.1),
       stretched(scaled(star_sphere(2, 0.05, 4), 0.05), 1.5, 0.2, 0.2), stretched(make_body(Body::cube, 1), 2, 0.1, 0.05)},
      {},
      {},
      {},
      {},
      4,
      4000};
  for (int i = 0; i < 100; ++i)
    script.objects.push_back({{0.1 * (i / 20), 0.03 * (i % 20), 0}, 0.37 * i, i < 2 ? 1 : 0});
  for (int i = 0; i < 3; ++i)
    script.fingers.push_back({{0.1 * i, 0.1 * i, 0}, 1.3 * i, 0});
  script.pose = [](const Actor& object, int tick, fdcg_pose* pose) {
    const double swing = object.kind == 1 ? 0.2 * std::sin(0.005 * tick) : 0;
    *pose =
        posed({object.home[0], object.home[1], object.home[2] + 0.1 * swing}, {0, 0, 1}, 0.1 * std::sin(object.phase) + swing);
    return object.kind == 1;
  };
  script.hip = [](const Actor& finger, int tick) {
    const double t = kTick_s * tick;
    return Place{finger.home[0] + 0.05 * std::sin(1.1 * t + finger.phase), 0.28 + 0.27 * std::sin(0.7 * t + finger.phase),
                 0.012 + 0.012 * std::sin(9 * t + finger.phase)};
  };
  return script;
}

// A hundred balls that wander and turn; one finger in ten rides on one, two in ten move close by, the others between.
Script crowd(int fingers, int level) {
  Script script = {"crowd", {scaled(star_sphere(level, 0.1, 3), 0.05)}, {}, {}, {}, {}, 4, 200};
  for (int i = 0; i < 100; ++i)
    script.objects.push_back({{0.25 * (i % 10), 0.25 * (i / 10), 0}, 0.37 * i, 0});
  for (int i = 0; i < fingers; ++i)
    script.fingers.push_back({script.objects[static_cast<std::size_t>(i % 100)].home, 0.11 * i, i / 100 % 10});
  const auto wander = [](const Place& home, double phase, int tick) {
    const double t = 4 * kTick_s * tick + phase;
    return Place{home[0] + 0.02 * std::sin(t), home[1] + 0.02 * std::cos(t), home[2] + 0.02 * std::sin(1.7 * t)};
  };
  script.pose = [wander](const Actor& object, int tick, fdcg_pose* pose) {
    *pose = posed(wander(object.home, object.home[0] + 3 * object.home[1], tick), {0.6, 0, 0.8}, 0.002 * tick);
    return true;
  };
  script.hip = [wander](const Actor& finger, int tick) {
    const Place middle = finger.kind < 3 ? wander(finger.home, finger.home[0] + 3 * finger.home[1], tick) : finger.home;
    const double a = finger.phase + 0.5 * kTick_s * tick, b = 1.618 * finger.phase, s = std::sin(b);
    const double away = finger.kind == 0 ? (tick < 2 ? 0.06 : 0.0485) : finger.kind < 3 ? 0.054 : 0.115;
    return Place{middle[0] + away * std::cos(a) * s, middle[1] + away * std::sin(a) * s, middle[2] + away * std::cos(b)};
  };
  return script;
}

// ---- a run
// -------------------------------------------------------------------------------------------------------------------

struct Switches {
  std::uint32_t scene = 0;  // fdcg_scene_optimization bits that are off
  std::uint32_t step = 0;   // fdcg_step_optimization bits that are off
  CompileOptions file = {};
  double mu_static = 0.5, mu_dynamic = 0.4, damping = 0;
};

struct Outcome {
  double mean_ns = 0, median_ns = 0, largest_ns = 0;  // a tick of one finger
  double largest_later_ns = 0;                        // the same without the ticks in which all fingers start
  double touching = 0;                                // share of the fingers
  std::uint64_t hash = 0xCBF29CE484222325u, file_bytes = 0, scene_bytes = 0, heap_calls = 0;
  std::uint64_t carried_over = 0;  // steps whose work was bounded: what they would feel comes a tick later
};

void add(std::uint64_t& hash, const double (&force)[3]) {
  std::uint64_t bits[3];
  std::memcpy(bits, force, sizeof bits);
  for (const std::uint64_t word : bits)
    hash = (hash ^ word) * 0x100000001B3u;
}

// Every tick's least time of the replays.
Outcome run(const Script& script, const Switches& switches, int replays, const Stopwatch& watch) {
  Outcome outcome;
  std::vector<std::unique_ptr<BenchGraph>> graphs;
  for (const PolygonSoup& body : script.bodies) {
    graphs.push_back(std::make_unique<BenchGraph>(body, switches.file));
    outcome.file_bytes += graphs.back()->view().header->file_bytes;
  }
  fdcg_scene_config config = fdcg_make_scene_config();
  config.object_capacity = static_cast<std::uint32_t>(script.objects.size());
  config.finger_capacity = static_cast<std::uint32_t>(script.fingers.size());
  config.touches_per_finger = script.touches_per_finger;
  config.disabled_optimizations = switches.scene;
  outcome.scene_bytes = fdcg_scene_bytes(&config);
  fdcg_params params = fdcg_make_params();
  params.mu_static = switches.mu_static;
  params.mu_dynamic = switches.mu_dynamic;
  params.damping_n_s_per_m = switches.damping;
  params.disabled_optimizations = switches.step;

  std::vector<float> least(static_cast<std::size_t>(script.ticks), 1e30F);
  for (int replay = 0; replay < replays; ++replay) {
    SceneRig scene(config);
    std::vector<fdcg_object_id> objects;
    std::vector<fdcg_finger_id> fingers;
    for (std::size_t i = 0; i < script.objects.size(); ++i) {
      fdcg_pose pose = posed(script.objects[i].home);
      script.pose(script.objects[i], 0, &pose);
      objects.push_back(scene.add(graphs[i % graphs.size()]->view(), params, pose));
    }
    for (const Actor& finger : script.fingers)
      fingers.push_back(scene.add(script.hip(finger, 0)));
    const std::uint64_t heap_before = heap_calls();
    for (int tick = 0; tick < script.ticks; ++tick) {
      fdcg_pose pose;
      for (std::size_t i = 0; i < objects.size(); ++i) {
        if (script.pose(script.objects[i], tick, &pose)) scene.pose(objects[i], pose);
      }
      for (std::size_t i = 0; i < fingers.size(); ++i)
        scene.move(fingers[i], script.hip(script.fingers[i], tick));
      const std::uint64_t begin = Stopwatch::now();
      scene.step();
      const double ns = watch.nanoseconds(begin, Stopwatch::now()) / static_cast<double>(fingers.size());
      auto& best = least[static_cast<std::size_t>(tick)];
      best = std::min(best, static_cast<float>(ns));
      if (replay > 0) continue;
      for (const fdcg_finger_id finger : fingers) {
        const fdcg_finger_result felt = scene.result(finger);
        add(outcome.hash, felt.force_n);
        outcome.touching += felt.touch_count > 0;
        outcome.carried_over += (felt.flags & FDCG_FINGER_BOUNDED) != 0;
      }
    }
    outcome.heap_calls += heap_calls() - heap_before;
  }
  outcome.touching /= static_cast<double>(script.fingers.size()) * script.ticks;
  constexpr std::size_t kStart = 5;  // ticks
  for (std::size_t tick = 0; tick < least.size(); ++tick) {
    outcome.mean_ns += least[tick] / script.ticks;
    if (tick >= kStart) outcome.largest_later_ns = std::max(outcome.largest_later_ns, double{least[tick]});
  }
  const Percentiles percentiles(std::move(least));
  outcome.median_ns = percentiles.at(0.5);
  outcome.largest_ns = percentiles.at(1);
  return outcome;
}

// ---- the table
// ---------------------------------------------------------------------------------------------------------------

struct Row {
  const char* name;
  Switches switches;
  bool is_same_physics = true;       // the forces must be the same bits
  bool needs_longer_sweeps = false;  // ... but where a sweep is more than a step's work, and goes on in the next tick
};

std::vector<Row> rows() {
  std::vector<Row> all = {{"everything skipped", {}}};
  const std::pair<const char*, std::uint32_t> scene_skips[] = {{"looks when out of reach", FDCG_OPT_OUT_OF_REACH},
                                                               {"objects far away", FDCG_OPT_FAR_OBJECTS},
                                                               {"still objects", FDCG_OPT_STILL},
                                                               {"rotation of unturned", FDCG_OPT_ROTATION},
                                                               {"renewal of contacts", FDCG_OPT_RENEWAL}};
  for (const auto& [name, bits] : scene_skips) {
    all.push_back({name, {}});
    all.back().switches.scene = bits;
  }
  all.push_back({"clear balls of the sweep", {}});
  all.back().switches.step = FDCG_STEP_OPT_CLEAR_BALL;
  all.push_back({"all of the above", {}});
  all.back().switches.scene = FDCG_OPT_ALL;
  all.back().switches.step = FDCG_STEP_OPT_ALL;
  all.push_back({"file: hierarchy", {}});
  all.back().switches.file.without = {"hierarchy"};
  all.back().needs_longer_sweeps = true;
  all.push_back({"file: stored planes", {}});
  all.back().switches.file.store_planes = false;
  all.push_back({"file: source map, info", {}});
  all.back().switches.file.without = {"source-map", "info"};
  all.push_back({"friction (mu 0)", {}, false});
  all.back().switches.mu_static = all.back().switches.mu_dynamic = 0;
  all.push_back({"damping on", {}, false});
  all.back().switches.damping = 1;
  return all;
}

bool print_table(const std::vector<Script>& scripts, int replays, const Stopwatch& watch) {
  bool holds = true;
  std::printf("\nWithout each skip: ns a finger and tick (mean of each tick's least of %d), times all skips on, bytes more.\n",
              replays);
  std::printf("%-8s %-26s %9s %9s %9s %7s %12s %s\n", "scene", "not skipped / left out", "mean", "median", "largest", "ratio",
              "bytes", "forces");
  for (const Script& script : scripts) {
    Outcome all;
    for (const Row& row : rows()) {
      if (row.switches.file.without.count("hierarchy") != 0 && script.bodies[0].face_count() > kMostWithoutHierarchy) {
        std::printf("%-8s %-26s a graph of so many faces needs it\n", script.name, row.name);
        continue;
      }
      const Outcome one = run(script, row.switches, replays, watch);
      if (std::string_view(row.name) == "everything skipped") all = one;
      const bool is_same = one.hash == all.hash,
                 is_right = is_same || !row.is_same_physics || (row.needs_longer_sweeps && one.carried_over > 0);
      const auto bytes =
          static_cast<long long>(one.file_bytes + one.scene_bytes) - static_cast<long long>(all.file_bytes + all.scene_bytes);
      std::printf("%-8s %-26s %9.1f %9.1f %9.1f %7.2f %12lld %s\n", script.name, row.name, one.mean_ns, one.median_ns,
                  one.largest_ns, one.mean_ns / all.mean_ns, bytes,
                  !row.is_same_physics ? "other physics"
                  : is_same            ? "same bits"
                  : is_right           ? "same but for sweeps carried over"
                                       : "DIFFER");
      std::fflush(stdout);
      holds = holds && is_right && (one.heap_calls == 0 || !can_count_heap_calls());
    }
    std::printf(
        "%-8s scene %llu bytes, files %llu bytes, %.1f %% of the steps touch; one contact for every finger and object: %zu "
        "bytes\n",
        script.name, static_cast<unsigned long long>(all.scene_bytes), static_cast<unsigned long long>(all.file_bytes),
        100 * all.touching, script.objects.size() * script.fingers.size() * sizeof(fdcg_contact));
  }
  return holds;
}

// ---- bars
// --------------------------------------------------------------------------------------------------------------------

bool print_bar(const char* what, double measured, double bar, const char* unit) {
  std::printf("%-64s %10.1f %s, bar %.1f%s\n", what, measured, unit, bar, measured <= bar ? "" : "  MISSED");
  return measured <= bar;
}

// Objects in rows; a finger that passes them 10 sizes away, one that looks in every tick, and one that is somewhere else among
// them in every tick.
bool print_free_bars(const Stopwatch& watch) {
  constexpr int kReplays = 40;
  bool holds = true;
  for (const int count : {1, 10, 100, 1000}) {
    Script script = {"", {make_body(Body::cube, 1)}, {}, {{{0, 0, 0}, 0, 0}}, {}, {}, 4, 500};
    for (int i = 0; i < count; ++i)
      script.objects.push_back({{0.3 * (i % 10), 0.3 * (i / 10 % 10), 0.3 * (i / 100)}, 0, 0});
    script.pose = [](const Actor&, int, fdcg_pose*) { return false; };
    script.hip = [](const Actor&, int tick) { return Place{1e-4 * tick, -1, 0.5}; };
    std::printf("%d objects\n", count);
    const Outcome far = run(script, {}, kReplays, watch);
    holds = print_bar("  nothing in reach: median", far.median_ns, 15, "ns") && holds;
    holds = print_bar("  nothing in reach: largest (the first look)", far.largest_ns, 5000, "ns") && holds;
    Switches looking;
    looking.scene = FDCG_OPT_OUT_OF_REACH;
    holds = print_bar("  a look: median", run(script, looking, kReplays, watch).median_ns, 3000, "ns") && holds;
    script.hip = [](const Actor&, int tick) {
      const auto at = [tick](std::uint64_t k) { return 3 * hashed_unit(k, static_cast<std::uint64_t>(tick)); };
      return Place{at(1), at(2), at(3)};
    };
    const Outcome jumps = run(script, {}, kReplays, watch);
    holds = print_bar("  across all of them in one tick: median", jumps.median_ns, 5000, "ns") && holds;
    holds = print_bar("  across all of them in one tick: largest", jumps.largest_ns, 5000, "ns") && holds;
  }
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  bool is_quick = false;
  std::string_view part = "all";
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--quick") {
      is_quick = true;
    } else if (std::string_view(argv[i]) == "--part" && i + 1 < argc) {
      part = argv[++i];
    } else {
      std::fprintf(stderr, "usage: %s [--quick] [--part free|crowd|table]\n", argv[0]);
      return 2;
    }
  }
  const Stopwatch watch;
  bool holds = true;
  if (part == "all" || part == "free") holds = print_free_bars(watch);
  if (part == "all" || part == "crowd") {
    Script many = crowd(10000, 3);
    if (is_quick) many.ticks = 60;
    const Outcome out = run(many, {}, is_quick ? 3 : 15, watch);
    holds = print_bar("10,000 fingers over 100 moving objects: median tick", out.median_ns * 10000 / 1000, 1000, "us") && holds;
    holds = print_bar("  largest tick after the first five", out.largest_later_ns * 10000 / 1000, 1000, "us") && holds;
  }
  if (part == "all" || part == "table") {
    std::vector<Script> scripts = {one_finger(), tray(), crowd(is_quick ? 1000 : 10000, 2)};
    scripts[2].ticks = is_quick ? 40 : 60;
    holds = print_table(scripts, is_quick ? 2 : 3, watch) && holds;
  }
  return holds ? 0 : 1;
}
