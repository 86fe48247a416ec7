// SPDX-License-Identifier: Apache-2.0
// What a tick of fingers and bodies costs: five fingers, three bodies, ground, all of them touching; and what sleep and the
// other things that are left undone save, with the motions compared bit for bit where they must be the same.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "heap_count.hpp"
#include "pile_rig.hpp"
#include "stopwatch.hpp"

using namespace fdcg::test;

namespace {

constexpr int kTicks = 4000, kWarmUp = 1500;
constexpr double kBar_ns = 5000, kStiffness = 2000;  // N/m

struct Row {
  const char* name;
  bool is_held_still = false;
  bool sleeps = true;
  std::uint32_t disabled_optimizations = 0;
  int bystanders = 0;  // fixed objects far away
  std::uint32_t substeps = 1;
};

struct Outcome {
  double median_ns = 0, p99_ns = 0, largest_ns = 0;
  double touches = 0, finger_touches = 0, asleep = 0;  // means
  std::uint64_t hash = 0xCBF29CE484222325u, heap_calls = 0;
};

// A ball of 1,280 faces that three fingers hold and swing; a box that two fingers push to and fro on the ground; one upon it.
class Table {
 public:
  explicit Table(const Row& row) : rig_(config(row)), row_(row) {
    fdcg_body_config like = fdcg_make_body_config();
    if (!row.sleeps) like.sleep_after_s = 0;
    const fdcg_params params = friction(0.8, 0.7, kStiffness);
    const auto ball = rig_.shape(scaled(ico_sphere(3), 0.03)), box = rig_.box(0.06, 0.06, 0.04);
    rig_.ground({0, 0, 1}, 0, params);
    fdcg_body_config damped = like;
    damped.linear_damping_per_s = damped.angular_damping_per_s = 20;
    rig_.add_body(ball, 0.05, params, posed({0, 0, 0.2}), damped);
    rig_.add_body(box, 0.1, params, posed({0.3, 0, 0.0199}), like);
    rig_.add_body(box, 0.05, params, posed({0.305, 0.002, 0.0597}, {0, 0, 1}, 0.1), like);
    for (int i = 0; i < row.bystanders; ++i)
      rig_.add_fixed(box, params, posed({0.1 * i, 3, 0.5}));
    for (int i = 0; i < 5; ++i)
      fingers_.push_back(rig_.scene().add(hip(i, 0, 0.01)));
    rig_.scene().step();
    for (int i = 0; i < 5; ++i)
      rig_.scene().move(fingers_[static_cast<std::size_t>(i)], hip(i, 0, 0));
    rig_.scene().step();  // closed while all is held still
  }
  void move(int tick) {
    const double t = row_.is_held_still ? 0 : 1e-3 * tick;
    for (int i = 0; i < 5; ++i)
      rig_.scene().move(fingers_[static_cast<std::size_t>(i)], hip(i, t, 0));
  }
  void tick() { rig_.tick(row_.substeps); }
  [[nodiscard]] PileRig& rig() { return rig_; }
  // What fdcg_body_substeps says of a body that three fingers press from within its reach, or two and the springs of its
  // touches.
  [[nodiscard]] std::uint32_t substeps_asked() {
    std::uint32_t most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double reach_m = i == 0 ? 0.03 : 0.047, fingers_n_per_m = i == 0 ? 3 * kStiffness : i == 1 ? 2 * kStiffness : 0;
      double springs = fingers_n_per_m;
      for (const fdcg_pile_touch& touch : rig_.touches()) {
        if (touch.object.index == rig_.object(i).index || touch.on.index == rig_.object(i).index)
          springs += touch.stiffness_n_per_m;
      }
      most = std::max(most, fdcg_body_get_substeps(&rig_.body(i), springs, reach_m, 1e-3));
    }
    return most;
  }
  [[nodiscard]] int finger_touches() {
    int count = 0;
    for (const fdcg_finger_id finger : fingers_)
      count += static_cast<int>(rig_.scene().result(finger).touch_count);
    return count;
  }

 private:
  static fdcg_pile_config config(const Row& row) {
    fdcg_pile_config config = fdcg_make_pile_config();
    config.disabled_optimizations = row.disabled_optimizations;
    return config;
  }
  static Place hip(int finger, double t, double away) {
    if (finger < 3) {
      const double turn = 2 * M_PI * finger / 3, reach = 0.029 + away;
      return {reach * std::cos(turn) + 0.01 * std::sin(3 * t), reach * std::sin(turn) + 0.01 * std::sin(2 * t),
              0.2 + 0.005 * std::sin(5 * t)};
    }
    const double side = finger == 3 ? -1 : 1;
    return {0.3 + side * (0.0297 + away) + 0.004 * std::sin(4 * t), 0, 0.02};
  }

  PileRig rig_;
  Row row_;
  std::vector<fdcg_finger_id> fingers_;
};

void add(std::uint64_t& hash, const double (&numbers)[3]) {
  std::uint64_t bits[3];
  std::memcpy(bits, numbers, sizeof bits);
  for (const std::uint64_t word : bits)
    hash = (hash ^ word) * 0x100000001B3u;
}

// Every tick's least time of the replays.
Outcome run(const Row& row, int replays, const Stopwatch& watch) {
  Outcome outcome;
  std::vector<float> least(kTicks, 1e30F);
  for (int replay = 0; replay < replays; ++replay) {
    Table table(row);
    table.rig().tick(row.substeps);
    const std::uint64_t heap_before = heap_calls();
    for (int tick = 0; tick < kWarmUp + kTicks; ++tick) {
      table.move(tick);
      const std::uint64_t begin = Stopwatch::now();
      table.tick();
      const double ns = watch.nanoseconds(begin, Stopwatch::now());
      if (tick >= kWarmUp) {
        float& best = least[static_cast<std::size_t>(tick - kWarmUp)];
        best = std::min(best, static_cast<float>(ns));
      }
      if (replay > 0) continue;
      if (tick >= kWarmUp) outcome.finger_touches += table.finger_touches() / double{kTicks};
      for (const fdcg_scene_body& body : table.rig().bodies()) {
        add(outcome.hash, body.body.centre_m);
        add(outcome.hash, body.body.angular_momentum);
        if (tick >= kWarmUp) outcome.asleep += body.body.is_asleep / double{kTicks};
      }
      if (tick >= kWarmUp) outcome.touches += fdcg_pile_get_touches(table.rig().pile(), nullptr, 0) / double{kTicks};
    }
    outcome.heap_calls += heap_calls() - heap_before;
  }
  const Percentiles percentiles(std::move(least));
  outcome.median_ns = percentiles.at(0.5);
  outcome.p99_ns = percentiles.at(0.99);
  outcome.largest_ns = percentiles.at(1);
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  int replays = 5;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--quick") {
      replays = 1;
    } else {
      std::fprintf(stderr, "usage: %s [--quick]\n", argv[0]);
      return 2;
    }
  }
  const Stopwatch watch;
  Table asked{Row{"moving"}};
  asked.rig().ticks(kWarmUp);
  const Row rows[] = {{"moving"},
                      {"moving, 4 substeps", false, true, 0, 0, 4},
                      {"moving, each asks all", false, true, FDCG_PILE_OPT_FAR},
                      {"moving, 60 bystanders", false, true, 0, 60},
                      {"moving, 60, each asks all", false, true, FDCG_PILE_OPT_FAR, 60},
                      {"held still, asleep", true},
                      {"held still, asleep, stepped", true, true, FDCG_PILE_OPT_STILL},
                      {"held still, awake", true, false}};
  std::printf(
      "Five fingers, three bodies, ground: ns a tick (each tick's least of %d; bar %.0f). Springs of %.0f N/m ask for %u "
      "substep(s).\n",
      replays, kBar_ns, kStiffness, asked.substeps_asked());
  std::printf("%-28s %9s %9s %9s %8s %8s %7s %s\n", "", "median", "99 %", "largest", "touches", "fingers'", "asleep", "motion");
  bool holds = true;
  std::uint64_t moving = 0, still = 0;
  for (const Row& row : rows) {
    const Outcome one = run(row, replays, watch);
    std::uint64_t& first = row.is_held_still ? still : moving;
    const bool may_differ = row.substeps != 1 || (row.is_held_still && !row.sleeps);
    if (first == 0) first = one.hash;
    const bool is_same = one.hash == first,
               is_fast = row.substeps > 1 || row.disabled_optimizations != 0 || one.p99_ns <= kBar_ns;
    std::printf("%-28s %9.0f %9.0f %9.0f %8.1f %8.1f %7.1f %s%s\n", row.name, one.median_ns, one.p99_ns, one.largest_ns,
                one.touches, one.finger_touches, one.asleep,
                is_same      ? "same bits"
                : may_differ ? "other physics"
                             : "DIFFERS",
                is_fast ? "" : "  MISSED");
    std::fflush(stdout);
    holds = holds && (is_same || may_differ) && is_fast && (one.heap_calls == 0 || !can_count_heap_calls());
  }
  return holds ? 0 : 1;
}
