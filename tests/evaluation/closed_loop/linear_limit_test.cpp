// SPDX-License-Identifier: Apache-2.0
#include "linear_limit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "catch.hpp"

using namespace fdcg::test;

namespace {

// Of z^2 - (a + d) z + (a d - b c), for the loop without delay and damping of the wall.
double radius_by_formula(const LoopSetup& setup, double k) {
  const HeldStep h = held_step(setup.plant, setup.tick_s());
  using Wide = long double;
  const Wide gain[2] = {h.gain[0], h.gain[1]}, wall = k;
  const Wide a = h.transition[0][0] - gain[0] * wall, b = h.transition[0][1], c = h.transition[1][0] - gain[1] * wall,
             d = h.transition[1][1];
  const std::complex<Wide> root = std::sqrt(std::complex<Wide>((a - d) * (a - d) / 4 + b * c));
  return static_cast<double>(std::max(std::abs((a + d) / 2 + root), std::abs((a + d) / 2 - root)));
}

}  // namespace

TEST_CASE("the spectral radius of the plain loop is that of its quadratic") {
  for (const double rate : {500.0, 1000.0, 40000.0}) {
    for (const double k : {10.0, 500.0, 2000.0, 2100.0, 50000.0}) {
      const LoopSetup setup = {{0.1, 1, 0, 0}, rate, 0, 0, 0};
      CHECK(static_cast<double>(spectral_radius(setup, k)) == Approx(radius_by_formula(setup, k)).epsilon(1e-11));
    }
  }
}

TEST_CASE("the limit of a light mass is the line b = K T / 2, and delay divides it by 2 n + 1") {
  for (int delay = 0; delay <= kMostDelay_ticks; ++delay) {
    const LoopSetup setup = {{0.1, 1e-3, 0, 0}, 1000, delay, 0, 0};  // b T / m is 1e-5: sampling is fine against all it does
    const double limit = exact_limit_n_per_m(setup), line = passivity_line_n_per_m(1e-3, setup);
    CHECK(line == Approx(1e-3 * 2000 / (2 * delay + 1)));
    CHECK(limit / line == Approx(1).epsilon(1e-3));
    CHECK(limit > line);
  }
}

TEST_CASE("no wall that the lines call passive is unstable, and a wall's damping counts against the device's") {
  for (const double b : {0.2, 1.0, 8.0}) {
    for (const double rate : {500.0, 4000.0, 40000.0}) {
      for (const double share : {0.0, 0.3, 0.9}) {
        LoopSetup setup = {{0.1, b, 0, 0}, rate, 0, share * b, 0};
        CHECK(exact_limit_n_per_m(setup) > passivity_line_n_per_m(b, setup));
      }
    }
  }
}

TEST_CASE("the encoder's line is the lower of sampling and dry friction") {
  LoopSetup setup = {{0.1, 1, 0, 0.05}, 1000, 0, 0, 1e-5};
  CHECK(encoder_line_n_per_m(1, setup) == Approx(2000));
  setup.quantum_m = 1e-4;
  CHECK(encoder_line_n_per_m(1, setup) == Approx(1000));
  setup.delay_ticks = 1;
  CHECK(std::isnan(encoder_line_n_per_m(1, setup)));
}
