// SPDX-License-Identifier: Apache-2.0
// One degree of freedom of a haptic device: m x'' + b x' + k x + c sign(x') = u, with u held between ticks. Between ticks it is
// integrated exactly, by the exponential of its matrix: what is seen of a closed loop is the loop's, not an integrator's.
#pragma once

#include <array>
#include <cstddef>

namespace fdcg::test {

struct Plant {
  double mass_kg = 0.1;
  double damping_n_s_per_m = 0;
  double stiffness_n_per_m = 0;  // to the ground: a hand that holds on; 0 without
  double coulomb_n = 0;          // dry friction of the mechanism, >= 0
};

struct PlantState {
  double x_m = 0, v_m_per_s = 0;
};

// exp(matrix) by scaling and squaring of its series; the matrix is small and its norm moderate. Relative error of some units in
// the last place of a long double times the number of squarings.
template <std::size_t n>
using SquareMatrix = std::array<std::array<long double, n>, n>;
template <std::size_t n>
SquareMatrix<n> product(const SquareMatrix<n>& a, const SquareMatrix<n>& b) {
  SquareMatrix<n> c{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < n; ++j)
        c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}
SquareMatrix<3> exponential(const SquareMatrix<3>& matrix);

// The plant over a fixed time under a constant force, without dry friction: next = transition * state + gain * force.
struct HeldStep {
  double transition[2][2];
  double gain[2];

  [[nodiscard]] PlantState operator()(const PlantState& s, double force_n) const {
    return {transition[0][0] * s.x_m + transition[0][1] * s.v_m_per_s + gain[0] * force_n,
            transition[1][0] * s.x_m + transition[1][1] * s.v_m_per_s + gain[1] * force_n};
  }
};
HeldStep held_step(const Plant& plant, double time_s);

// The plant from tick to tick. With dry friction a tick is cut where the velocity changes its sign, found to 2^-50 of the tick:
// there the plant stays where |u - k x| <= c, and goes on against the new direction otherwise. Ticks are shorter than half a
// swing of the plant on its own spring.
class HeldPlant {
 public:
  HeldPlant(const Plant& plant, double tick_s);
  [[nodiscard]] PlantState after_tick(PlantState state, double force_n) const;

 private:
  [[nodiscard]] PlantState with_dry_friction(PlantState state, double force_n) const;
  [[nodiscard]] double standstill_s(const PlantState& start, double net_n, double left_s) const;

  Plant plant_;
  double tick_s_;
  HeldStep whole_;
};

}  // namespace fdcg::test
