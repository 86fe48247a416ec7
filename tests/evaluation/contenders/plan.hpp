// SPDX-License-Identifier: Apache-2.0
// Which contenders go along which ways on which bodies.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "contender.hpp"
#include "ways.hpp"

namespace fdcg::test {

struct WayPlan {
  WayKind kind;
  double rate_hz = 1000;
  double mu_static = 0, mu_dynamic = 0;
  bool counts = false;  // for the frontier of its body: at most one of a body's ways does
  std::uint32_t most_ticks = 10'000;
};

struct BodyPlan {
  std::string body;
  std::vector<WayPlan> ways;
};

std::vector<BodyPlan> plan_of(bool is_quick);

// How much is measured of a way: of those that count, many short ones, since what a hand does there differs more from way to
// way than within one.
struct WayMeasure {
  std::uint32_t ways = 1;      // of seeds one after the other
  std::uint32_t ticks = 0;     // of each
  std::size_t cold_ticks = 0;  // of each: before each of them the caches are swept, some milliseconds for each contender
  double budget_s = 0;         // of each way, for warm rounds; where that is too few rounds it takes longer
};
WayMeasure measure_of(const WayPlan& way, bool is_quick);

// The ways of a body that the plan lacks; of meshes that others bring.
std::vector<WayPlan> ways_of_other(const Body& body);
std::vector<WayPlan> ways_of_brought();

using Contenders = std::vector<std::unique_ptr<Contender>>;
// The first is the runtime in double with stored planes.
Contenders contenders_for(const Ground& ground, const Body& body, bool is_quick);
// ... and the rivals that were built, and others, by make_rival()'s specifications.
Contenders all_contenders_for(const Ground& ground, const Body& body, bool is_quick, const std::vector<std::string>& rivals);

}  // namespace fdcg::test
