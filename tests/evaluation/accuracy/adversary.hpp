// SPDX-License-Identifier: Apache-2.0
// Searches for the ticks where the runtime is furthest from the exact answer: short ways of the HIP and friction, first at
// random from recipes that are hard (grazes, aims at corners, distances of rounding), then climbing from the worst found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "replay.hpp"

namespace fdcg::test {

struct AdversaryCase {
  double mu_static = 0, mu_dynamic = 0;
  std::vector<Hip> hips;
};

struct AdversaryFind {
  AdversaryCase way;
  double ulps = 0, conditioning = 1;  // of its worst tick by the goal
  std::uint32_t transitions = 0;
  std::string what;  // everything about that tick

  // How far the inputs of that tick must be moved, at the least, for the exact answer to be the runtime's.
  [[nodiscard]] double backward_ulps() const { return ulps / conditioning; }
};

// Up to here the bar on errors holds. Beyond it, an ulp of the HIP moves the exact answer by more than that.
constexpr double kMostWellPosed = 64;

enum class AdversaryGoal { error, backward_error, transitions };
const char* name_of(AdversaryGoal goal);

class Adversary {
 public:
  // `soup` in the graph's object frame at one metre per unit.
  Adversary(const fdcg_graph& graph, const bake::PolygonSoup& soup, std::uint64_t seed);

  // The worst of so many cases. Ties count for nothing; ticks that are wrong without being ties go into `wrong`.
  AdversaryFind search(AdversaryGoal goal, int cases);

  std::uint64_t ticks = 0, wrong = 0;
  double well_posed_ulps = 0;  // the largest error of a tick whose conditioning is at most kMostWellPosed
  std::string first_wrong;

 private:
  AdversaryFind judged(AdversaryGoal goal, const AdversaryCase& way);
  AdversaryCase fresh();
  AdversaryCase changed(AdversaryCase way);
  void set_friction(AdversaryCase& way);
  Hip hip_after(const std::vector<Hip>& hips);
  Hip corner();
  Hip on_edge();
  Hip shaken(Hip p, double least_power, double most_power);

  const bake::PolygonSoup& soup_;
  Random random_;
  double size_ = 0;
  Replay<long double> replay_;
};

}  // namespace fdcg::test
