// SPDX-License-Identifier: Apache-2.0
#include "held_plant.hpp"

#include <algorithm>
#include <cmath>

namespace fdcg::test {

SquareMatrix<3> exponential(const SquareMatrix<3>& matrix) {
  constexpr int kTerms = 18;            // 0.5^18 / 18! is below a long double's rounding
  constexpr long double kSmall = 0.5L;  // largest row sum that the series is summed for
  long double norm = 0;
  for (const auto& row : matrix)
    norm = std::max(norm, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
  int squarings = 0;
  for (; norm > kSmall; norm /= 2)
    ++squarings;
  SquareMatrix<3> scaled = matrix;
  for (auto& row : scaled) {
    for (long double& x : row)
      x = std::ldexp(x, -squarings);
  }
  constexpr SquareMatrix<3> kUnit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  SquareMatrix<3> sum = kUnit;
  for (int term = kTerms; term > 0; --term) {  // Horner: 1 + A / 1 (1 + A / 2 (1 + ...))
    sum = product(scaled, sum);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j)
        sum[i][j] = sum[i][j] / term + kUnit[i][j];
    }
  }
  for (int k = 0; k < squarings; ++k)
    sum = product(sum, sum);
  return sum;
}

HeldStep held_step(const Plant& plant, double time_s) {
  const long double t = time_s, m = plant.mass_kg;
  const SquareMatrix<3> e =
      exponential({{{0, t, 0}, {-plant.stiffness_n_per_m / m * t, -plant.damping_n_s_per_m / m * t, t / m}, {0, 0, 0}}});
  const auto at = [&](std::size_t i, std::size_t j) { return static_cast<double>(e[i][j]); };
  return {{{at(0, 0), at(0, 1)}, {at(1, 0), at(1, 1)}}, {at(0, 2), at(1, 2)}};
}

HeldPlant::HeldPlant(const Plant& plant, double tick_s) : plant_(plant), tick_s_(tick_s), whole_(held_step(plant, tick_s)) {}

PlantState HeldPlant::after_tick(PlantState state, double force_n) const {
  return plant_.coulomb_n > 0 ? with_dry_friction(state, force_n) : whole_(state, force_n);
}

// Where the velocity changes its sign between 0 and left_s, under a constant net force: Newton's steps, kept between the times
// of which the sign is known.
double HeldPlant::standstill_s(const PlantState& start, double net_n, double left_s) const {
  constexpr int kMostSteps = 80;
  const double heading = std::copysign(1.0, start.v_m_per_s), resolution_s = std::ldexp(tick_s_, -50);
  double before = 0, after = left_s, t = left_s / 2;
  for (int step = 0; step < kMostSteps && after - before > resolution_s; ++step) {
    const PlantState now = held_step(plant_, t)(start, net_n);
    if (now.v_m_per_s == 0) return t;
    (now.v_m_per_s * heading > 0 ? before : after) = t;
    const double acceleration =
        (net_n - plant_.stiffness_n_per_m * now.x_m - plant_.damping_n_s_per_m * now.v_m_per_s) / plant_.mass_kg;
    const double next = t - now.v_m_per_s / acceleration;
    if (std::abs(next - t) < resolution_s) return t;
    t = next > before && next < after ? next : (before + after) / 2;
  }
  return t;
}

PlantState HeldPlant::with_dry_friction(PlantState state, double force_n) const {
  constexpr int kMostReversals = 8;  // in one tick; each needs half a swing of the plant, which is longer than a tick
  double left_s = tick_s_;
  for (int reversal = 0; reversal < kMostReversals; ++reversal) {
    const double drive_n = force_n - plant_.stiffness_n_per_m * state.x_m;
    const bool stands = state.v_m_per_s == 0;
    if (stands && std::abs(drive_n) <= plant_.coulomb_n) return state;
    const double heading = std::copysign(1.0, stands ? drive_n : state.v_m_per_s), net_n = force_n - heading * plant_.coulomb_n;
    const PlantState end = (left_s == tick_s_ ? whole_ : held_step(plant_, left_s))(state, net_n);
    // From a standstill it goes with what drives it; a tick is too short to come back.
    if (stands || end.v_m_per_s * heading >= 0) return end;
    const double stop_s = standstill_s(state, net_n, left_s);
    state = {held_step(plant_, stop_s)(state, net_n).x_m, 0};
    left_s -= stop_s;
  }
  return state;
}

}  // namespace fdcg::test
