// SPDX-License-Identifier: Apache-2.0
// What a step on each surface without a mesh costs: free, pressed and still, and sliding as a hand does, with friction and
// without. Figures as in step_bench.cpp: `tick` is one tick timed alone; `own` the same again from a copy of the contact, the
// least of seven replays; `batch` the whole way over its ticks. See README.md beside this file.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "fdcg/surface.h"
#include "heap_count.hpp"
#include "stopwatch.hpp"

using namespace fdcg::test;

namespace {

using Place = std::array<double, 3>;

constexpr double kDepth_m = 1e-3, kWay_m = 1e-4;  // of a tick: 0.1 m/s at 1 kHz
constexpr double kBar_ns = 60, kEllipsoidBar_ns = 150;

struct Options {
  int ticks = 100'000;
  int replays = 7;  // 0: each tick once, and no batch: for counting what a step does
  bool judges_times = true;
  std::string kind, way, friction;  // empty: all
};

// ---- surfaces of hand's size, and a way over each -----------------------------------------------------------------------

struct Shape {
  const char* name;
  fdcg_surface surface;
  Place (*point)(double u, double v);  // of the surface, at any angles u and v
};

Place times(const Place& p, double s) {
  return {p[0] * s, p[1] * s, p[2] * s};
}
Place plus(const Place& a, const Place& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
double distance(const Place& a, const Place& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
// Between the ends of the axis, seven tenths of the way to each.
double height(double v, double length) {
  return 0.35 * length * std::sin(v);
}
Place on_ball(double u, double v) {
  const double z = 0.9 * std::sin(v), r = std::sqrt(1 - z * z);
  return {r * std::cos(u), r * std::sin(u), z};
}

const Shape kShapes[] = {
    {"plane", fdcg_make_plane(),
     [](double u, double v) {
       return Place{0.05 * std::cos(u), 0.05 * std::sin(v), 0};
     }},
    {"sphere", fdcg_make_sphere(0.05), [](double u, double v) { return times(on_ball(u, v), 0.05); }},
    {"cylinder", fdcg_make_cylinder(0.04, 0.2),
     [](double u, double v) {
       return Place{0.04 * std::cos(u), 0.04 * std::sin(u), height(v, 0.2)};
     }},
    {"capsule", fdcg_make_capsule(0.03, 0.1),
     [](double u, double v) {
       const Place ball = on_ball(u, v);
       return plus(times(ball, 0.03), {0, 0, ball[2] > 0 ? 0.05 : -0.05});
     }},
    {"capsule's side", fdcg_make_capsule(0.03, 0.1),
     [](double u, double v) {
       return Place{0.03 * std::cos(u), 0.03 * std::sin(u), height(v, 0.1)};
     }},
    {"box", fdcg_make_box(0.05, 0.04, 0.06),
     [](double u, double v) {
       return Place{0.05, 0.03 * std::cos(u), 0.05 * std::sin(v)};
     }},
    {"cone", fdcg_make_cone(0.06, 0.03, 0.15),
     [](double u, double v) {
       const double z = height(v, 0.15), r = 0.045 - 0.2 * z;
       return Place{r * std::cos(u), r * std::sin(u), z};
     }},
    {"torus", fdcg_make_torus(0.06, 0.02),
     [](double u, double v) {
       const double r = 0.06 + 0.02 * std::cos(v);
       return Place{r * std::cos(u), r * std::sin(u), 0.02 * std::sin(v)};
     }},
    {"ellipsoid", fdcg_make_ellipsoid(0.06, 0.04, 0.05),
     [](double u, double v) {
       const Place ball = on_ball(u, v);
       return Place{0.06 * ball[0], 0.04 * ball[1], 0.05 * ball[2]};
     }},
};

// The surface's point and the hand's place `deep` below it.
struct Hand {
  Place point, normal;
  [[nodiscard]] Place at(double deep) const { return plus(point, times(normal, -deep)); }
};

// Points of a curve that winds over the surface and never closes, each kWay_m from the one before.
std::vector<Hand> slide(const Shape& shape, int ticks) {
  constexpr double kTurns = 0.37;  // of v to one of u
  const auto point = [&](double t) { return shape.point(t, kTurns * t); };
  std::vector<Hand> hands;
  double t = 0.1;
  for (int i = 0; i < ticks; ++i) {
    const Place here = point(t);
    fdcg_result on = {};
    on.state = FDCG_FACE;
    on.feature = shape.surface.kind == FDCG_SURFACE_BOX ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k)
      on.god_object_m[k] = here[k];
    Hand hand = {here, {}};
    fdcg_surface_get_normal(&shape.surface, &on, hand.normal.data());
    hands.push_back(hand);
    constexpr double kStep = 1e-6;
    const double first = kWay_m / (distance(point(t + kStep), here) / kStep);
    t += first * kWay_m / distance(point(t + first), here);
  }
  return hands;
}

struct Way {
  const char* name;
  double deep;     // of the hand, metres
  bool is_moving;  // else a tremor of a hundredth of the depth
};
constexpr Way kWays[] = {{"free", -2e-3, true}, {"still", kDepth_m, false}, {"slides", kDepth_m, true}};

std::vector<Place> path_of(const std::vector<Hand>& hands, const Way& way) {
  std::vector<Place> path = {hands[0].at(-0.01)};  // not in contact
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const double tremor = 0.01 * kDepth_m * std::sin(static_cast<double>(i));
    path.push_back(way.is_moving ? hands[i].at(way.deep) : plus(hands[0].at(way.deep), {tremor, -tremor, tremor}));
  }
  return path;
}

// ---- measuring ----------------------------------------------------------------------------------------------------------

struct Measured {
  Percentiles tick{{}}, own{{}};
  double batch_ns = 0, contact = 0, slipping = 0;  // shares of the ticks
  std::uint64_t heap_calls = 0, bounded = 0;
};

fdcg_contact first_contact(const fdcg_surface& surface, const fdcg_params& params, const std::vector<Place>& path) {
  fdcg_contact contact = {};
  fdcg_result result;
  for (std::size_t i = 0; i < 2; ++i)
    fdcg_surface_step(&surface, &params, &contact, path[i].data(), &result);
  return contact;
}

Measured measure(const fdcg_surface& surface, const fdcg_params& params, const std::vector<Place>& path, const Stopwatch& watch,
                 int replays) {
  const std::size_t ticks = path.size() - 2;
  std::vector<float> tick(ticks), own(ticks);
  Measured m;
  fdcg_result result;
  fdcg_contact contact = first_contact(surface, params, path);
  const std::uint64_t heap_before = heap_calls();
  for (std::size_t i = 0; i < ticks; ++i) {
    const fdcg_contact before = contact;
    const double* hip = path[i + 2].data();
    const std::uint64_t begin = Stopwatch::now();
    fdcg_surface_step(&surface, &params, &contact, hip, &result);
    tick[i] = static_cast<float>(watch.nanoseconds(begin, Stopwatch::now()));
    m.contact += result.state != FDCG_FREE;
    m.slipping += result.slipping;
    m.bounded += result.flags != 0;
    float least = tick[i];
    for (int replay = 0; replay < replays; ++replay) {
      fdcg_contact again = before;
      const std::uint64_t start = Stopwatch::now();
      fdcg_surface_step(&surface, &params, &again, hip, &result);
      least = std::min(least, static_cast<float>(watch.nanoseconds(start, Stopwatch::now())));
    }
    own[i] = least;
  }
  if (replays > 0) contact = first_contact(surface, params, path);
  const std::uint64_t begin = Stopwatch::now();
  for (std::size_t i = 0; replays > 0 && i < ticks; ++i)
    fdcg_surface_step(&surface, &params, &contact, path[i + 2].data(), &result);
  const auto count = static_cast<double>(ticks);
  m.batch_ns = watch.nanoseconds(begin, Stopwatch::now()) / count;
  m.heap_calls = heap_calls() - heap_before;
  m.contact /= count;
  m.slipping /= count;
  m.tick = Percentiles(std::move(tick));
  m.own = Percentiles(std::move(own));
  return m;
}

// ---- the table ----------------------------------------------------------------------------------------------------------

// What the row must keep: a way that is what its name says, no heap, and the time.
std::string judge(const Shape& shape, const Way& way, const Measured& m, bool has_friction, bool judges_times) {
  const bool is_free = way.deep < 0, slips = way.is_moving && !is_free;
  std::string text;
  if (m.contact != (is_free ? 0.0 : 1.0)) text += " CONTACT";
  if (has_friction && (slips ? m.slipping < 0.99 : m.slipping != 0)) text += " SLIP";
  if (m.bounded != 0) text += " BOUND";
  if (m.heap_calls != 0 && can_count_heap_calls()) text += " HEAP";
  const double bar_ns = shape.surface.kind == FDCG_SURFACE_ELLIPSOID ? kEllipsoidBar_ns : kBar_ns;
  if (judges_times && m.own.at(0.5) > bar_ns) text += " p50 of own <= " + std::to_string(static_cast<int>(bar_ns)) + ": MISSED";
  return text;
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--quick") {
      options.ticks = 2000;
      options.replays = 1;
      options.judges_times = false;
    } else if ((arg == "--kind" || arg == "--way" || arg == "--friction") && i + 1 < argc) {
      (arg == "--kind" ? options.kind : arg == "--way" ? options.way : options.friction) = argv[++i];
    } else if (arg == "--replays" && i + 1 < argc) {
      options.replays = std::max(0, std::atoi(argv[++i]));
    } else if (arg == "--ticks" && i + 1 < argc) {
      options.ticks = std::max(1000, std::atoi(argv[++i]));
    } else {
      std::printf(
          "usage: %s [--quick] [--ticks N] [--replays N] [--kind NAME] [--way NAME] [--friction yes,no]\n"
          "  --quick   few ticks, and times are not judged\n"
          "  --kind, --way, --friction: only these rows, named as in the table\n",
          argv[0]);
      std::exit(arg == "--help" ? 0 : 2);
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  const Stopwatch watch;
  std::printf("reading the clock costs %.0f ns, subtracted; all times in ns\n", watch.cost_ns());
  std::printf("%-14s %-6s %-8s | %6s %6s %6s | %6s %6s %6s | %6s\n", "", "way", "friction", "p50", "p99", "max", "own50",
              "own99", "max", "batch");
  int rows = 0, failures = 0;
  for (const Shape& shape : kShapes) {
    if (!options.kind.empty() && options.kind != shape.name) continue;
    const std::vector<Hand> hands = slide(shape, options.ticks);
    for (const Way& way : kWays) {
      if (!options.way.empty() && options.way != way.name) continue;
      const std::vector<Place> path = path_of(hands, way);
      for (const bool has_friction : {true, false}) {
        if (!options.friction.empty() && options.friction != (has_friction ? "yes" : "no")) continue;
        fdcg_params params = fdcg_make_params();
        if (!has_friction) params.mu_static = params.mu_dynamic = 0;
        const Measured m = measure(shape.surface, params, path, watch, options.replays);
        const std::string missed = judge(shape, way, m, has_friction, options.judges_times);
        failures += missed.empty() ? 0 : 1;
        ++rows;
        std::printf("%-14s %-6s %-8s | %6.0f %6.0f %6.0f | %6.0f %6.0f %6.0f | %6.0f %s\n", shape.name, way.name,
                    has_friction ? "yes" : "no", m.tick.at(0.5), m.tick.at(0.99), m.tick.at(1), m.own.at(0.5), m.own.at(0.99),
                    m.own.at(1), m.batch_ns, missed.c_str());
        std::fflush(stdout);
      }
    }
  }
  std::printf("rows that do not hold: %d of %d\n", failures, rows);
  return rows > 0 && failures == 0 ? 0 : 1;
}
