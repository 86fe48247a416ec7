// SPDX-License-Identifier: Apache-2.0
#include "linear_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fdcg::test {
namespace {

constexpr std::size_t kX = 0, kV = 1, kLast = 2, kForces = 3, kStates = kForces + kMostDelay_ticks;
using LoopMatrix = SquareMatrix<kStates>;

// From tick to tick: the force that is read now goes in at the end of the queue, that at its head acts until the next tick.
LoopMatrix loop_matrix(const LoopSetup& setup, double wall_n_per_m) {
  const HeldStep held = held_step(setup.plant, setup.tick_s());
  const long double damping = setup.virtual_damping_n_s_per_m / setup.tick_s();
  const auto delay = static_cast<std::size_t>(setup.delay_ticks);
  LoopMatrix m{};
  std::array<long double, kStates> now{}, acting{};  // as rows over the state
  now[kX] = -(wall_n_per_m + damping);
  now[kLast] = damping;
  if (delay == 0) {
    acting = now;
  } else {
    acting[kForces] = 1;
  }
  for (std::size_t j = 0; j < kStates; ++j) {
    for (std::size_t i : {kX, kV})
      m[i][j] = static_cast<long double>(held.gain[i]) * acting[j] + (j < 2 ? held.transition[i][j] : 0);
  }
  m[kLast][kX] = 1;
  for (std::size_t k = 0; k < delay; ++k) {
    if (k + 1 < delay) {
      m[kForces + k][kForces + k + 1] = 1;
    } else {
      m[kForces + k] = now;
    }
  }
  return m;
}

}  // namespace

// rho = lim |M^N|^(1 / N): N = 2^56 by squaring, the size kept apart as a logarithm.
long double spectral_radius(const LoopSetup& setup, double wall_n_per_m) {
  constexpr int kSquarings = 56;  // what the norm adds to the radius, some |M| ^ (1 / N), is then below rounding
  LoopMatrix power = loop_matrix(setup, wall_n_per_m);
  long double log_size = 0, per_power = 1;  // log |M^N| / N
  for (int k = 0; k < kSquarings; ++k) {
    long double size = 0;
    for (const auto& row : power) {
      for (const long double x : row)
        size = std::max(size, std::abs(x));
    }
    if (size == 0) return 0;
    for (auto& row : power) {
      for (long double& x : row)
        x /= size;
    }
    log_size += std::log(size) * per_power;
    power = product(power, power);
    per_power /= 2;
  }
  return std::exp(log_size);
}

double exact_limit_n_per_m(const LoopSetup& setup) {
  constexpr double kLeast_n_per_m = 1e-6, kMost_n_per_m = 1e9, kPrecision = 1e-9;
  double stable = kLeast_n_per_m, unstable = kMost_n_per_m;
  if (spectral_radius(setup, stable) > 1) return std::numeric_limits<double>::quiet_NaN();
  while (unstable / stable > 1 + kPrecision) {
    const double middle = std::sqrt(stable * unstable);
    (spectral_radius(setup, middle) > 1 ? unstable : stable) = middle;
  }
  return stable;
}

double passivity_line_n_per_m(double damping_n_s_per_m, const LoopSetup& setup) {
  const double virtual_damping = std::abs(setup.virtual_damping_n_s_per_m);
  if (virtual_damping > 0 && setup.delay_ticks > 0) return std::numeric_limits<double>::quiet_NaN();
  return (damping_n_s_per_m - virtual_damping) / (setup.tick_s() * (0.5 + setup.delay_ticks));
}

double encoder_line_n_per_m(double damping_n_s_per_m, const LoopSetup& setup) {
  if (setup.delay_ticks > 0 || setup.virtual_damping_n_s_per_m != 0) return std::numeric_limits<double>::quiet_NaN();
  const double sampled = 2 * damping_n_s_per_m / setup.tick_s();
  return setup.quantum_m > 0 ? std::min(sampled, 2 * setup.plant.coulomb_n / setup.quantum_m) : sampled;
}

}  // namespace fdcg::test
