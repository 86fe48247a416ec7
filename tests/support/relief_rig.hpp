// SPDX-License-Identifier: Apache-2.0
// A hand on a mesh with a relief, and what it feels on a stroke.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "fdcg/relief.h"

namespace fdcg::test {

inline constexpr double kReliefTick_s = 0.001, kReliefStiffness = 1000;

struct Felt {
  fdcg_relief relief;
  const fdcg_graph& graph;
  Contact contact;
  fdcg_relief_state state{};
  Hip force{};

  Felt(const fdcg_relief& of, const fdcg_graph& on, const fdcg_params& params) : relief(of), graph(on), contact(on, params) {
    fdcg_error error{};
    const bool is_taken = fdcg_check_relief(&relief, &error) == FDCG_OK;
    INFO(error.message);
    REQUIRE(is_taken);
  }
  const Hip& at(const Hip& hip) {
    double moved_m[3];
    fdcg_relief_move(&relief, &state, hip.data(), kReliefTick_s, moved_m);
    fdcg_result result = contact.step({moved_m[0], moved_m[1], moved_m[2]});
    fdcg_effect_facts facts;
    REQUIRE(fdcg_get_effect_facts(&graph, &result, moved_m, 0, kReliefTick_s, &facts, nullptr) == FDCG_OK);
    fdcg_relief_turn(&relief, &state, &facts, result.force_n);
    force = {result.force_n[0], result.force_n[1], result.force_n[2]};
    return force;
  }
};

inline fdcg_params relief_params(double mu_static, double mu_dynamic) {
  fdcg_params params = contact_params(mu_static, mu_dynamic);
  params.stiffness_n_per_m = kReliefStiffness;
  return params;
}

// A stroke along x at a speed, 1.5 mm deep below z = 0.5: force from the 50th tick on.
inline std::vector<Hip> stroke(Felt& felt, double speed_m_per_s, int ticks) {
  std::vector<Hip> forces;
  double x = -0.3;
  felt.at({x, 0.01, 0.51});
  for (int i = 0; i < ticks + 50; ++i) {
    felt.at({x += speed_m_per_s * kReliefTick_s, 0.01, 0.5 - 0.0015});
    if (i >= 50) forces.push_back(felt.force);
  }
  return forces;
}

inline std::complex<double> amplitude_at(const std::vector<Hip>& forces, std::size_t component, double hz) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < forces.size(); ++i)
    sum += forces[i][component] * std::polar(1.0, -2 * std::numbers::pi * hz * kReliefTick_s * static_cast<double>(i));
  return 2.0 / static_cast<double>(forces.size()) * sum;
}

}  // namespace fdcg::test
