// SPDX-License-Identifier: Apache-2.0
// A contact step's time over meshes of 80 to 1.3 million faces, along paths that cross as many faces a tick on each: what the
// mesh's size costs is what the table's columns differ by. Percentiles, since a servo loop lives by its slowest steps.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "meshes.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration time) {
  return std::chrono::duration<double, std::nano>(time).count();
}

// The least that reading the clock twice takes.
double clock_cost() {
  double least = 1e9;
  for (int i = 0; i < 1000; ++i) {
    const auto begin = Clock::now();
    least = std::min(least, nanoseconds(Clock::now() - begin));
  }
  return least;
}

struct Timing {
  std::vector<double> ns;  // sorted
  double transitions = 0;  // mean
  double contact = 0;      // share of ticks

  [[nodiscard]] double at(double share) const {
    return ns[static_cast<std::size_t>(share * static_cast<double>(ns.size() - 1))];
  }
};

// Around the unit sphere on a slowly turning great circle, a fifth of an edge below the surface.
Timing walk(const fdcg_graph& graph, double faces_a_tick, int ticks) {
  const double edge = std::sqrt(4 * std::numbers::pi / graph.header->node_count * 2.3);
  const double turn = faces_a_tick * edge / 2, radius = 1 - std::min(0.2 * edge, 0.05);
  fdcg_params params = fdcg_default_params();
  params.mu_static = params.mu_dynamic = 0.1;
  fdcg_contact contact = {};
  fdcg_result result;
  const double start[3] = {1.5, 0, 0};
  fdcg_step(&graph, &params, &contact, start, &result);
  Timing timing;
  timing.ns.reserve(static_cast<std::size_t>(ticks));
  const double cost = clock_cost();
  for (int i = 0; i < ticks; ++i) {
    const double a = turn * i, b = 0.0137 * a;
    const double hip[3] = {radius * std::cos(a) * std::cos(b), radius * std::sin(a), radius * std::cos(a) * std::sin(b)};
    const auto begin = Clock::now();
    fdcg_step(&graph, &params, &contact, hip, &result);
    timing.ns.push_back(std::max(0.0, nanoseconds(Clock::now() - begin) - cost));
    timing.transitions += result.transitions;
    timing.contact += result.state != FDCG_FREE;
  }
  std::sort(timing.ns.begin(), timing.ns.end());
  timing.transitions /= ticks;
  timing.contact /= ticks;
  return timing;
}

}  // namespace

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::atoi(argv[1]) : 400000;
  std::printf("precision     faces  bytes/face  faces/tick  transitions  contact   p50 ns   p99 ns  p99.9 ns   max ns\n");
  for (const auto precision : {fdcg::bake::Precision::f64, fdcg::bake::Precision::f32}) {
    for (const int level : {1, 4, 6, 8}) {
      fdcg::bake::CompileOptions options;
      options.precision = precision;
      const auto compiled = fdcg::bake::compile(fdcg::test::ico_sphere(level), options);
      fdcg_graph graph;
      fdcg_error error;
      if (!compiled ||
          fdcg_open_memory(compiled->bytes.data(), compiled->bytes.size(), FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) {
        return 1;
      }
      for (const double rate : {0.1, 0.5, 1.0, 4.0}) {
        const Timing t = walk(graph, rate, ticks);
        std::printf("%-9s %9u %11.0f %11.1f %12.2f %7.1f%% %8.0f %8.0f %9.0f %8.0f\n",
                    precision == fdcg::bake::Precision::f64 ? "f64" : "f32", graph.header->node_count,
                    static_cast<double>(compiled->bytes.size()) / graph.header->node_count, rate, t.transitions,
                    100 * t.contact, t.at(0.5), t.at(0.99), t.at(0.999), t.at(1));
      }
    }
  }
  return 0;
}
