// SPDX-License-Identifier: Apache-2.0
// The device's integrator against closed forms, against itself in smaller pieces, and against the balance of energy.
#include "held_plant.hpp"

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "random.hpp"

using namespace fdcg::test;

namespace {

void check_close(const PlantState& a, const PlantState& b, double tolerance) {
  CHECK(a.x_m == Approx(b.x_m).epsilon(tolerance).margin(tolerance));
  CHECK(a.v_m_per_s == Approx(b.v_m_per_s).epsilon(tolerance).margin(tolerance));
}

}  // namespace

TEST_CASE("a free mass, a damped mass and a spring move as their formulas say") {
  const double t = 0.37, u = 2.5;
  const PlantState start = {0.3, -1.7};
  check_close(held_step({0.2, 0, 0, 0}, t)(start, u),
              {start.x_m + start.v_m_per_s * t + u / 0.2 * t * t / 2, start.v_m_per_s + u / 0.2 * t}, 1e-15);
  const double rate = 1.5 / 0.2, settled = u / 1.5, decay = std::exp(-rate * t);  // damping 1.5
  check_close(held_step({0.2, 1.5, 0, 0}, t)(start, u),
              {start.x_m + settled * t + (start.v_m_per_s - settled) * (1 - decay) / rate,
               settled + (start.v_m_per_s - settled) * decay},
              1e-15);
  const double w = std::sqrt(80 / 0.2), at = u / 80, c = std::cos(w * t), s = std::sin(w * t);  // stiffness 80
  check_close(held_step({0.2, 0, 80, 0}, t)(start, u),
              {at + (start.x_m - at) * c + start.v_m_per_s / w * s, -(start.x_m - at) * w * s + start.v_m_per_s * c}, 2e-15);
}

TEST_CASE("one step is two of half the time, from loose to stiff and from light to overdamped") {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const auto power = [&](double low, double high) { return std::pow(10, random.uniform(low, high)); };
    const Plant plant = {power(-2, 0), power(-3, 2), power(-2, 5), 0};
    const double t = power(-5, -2), u = random.uniform(-10, 10);
    const PlantState start = {random.uniform(-1, 1), random.uniform(-1, 1)};
    const PlantState whole = held_step(plant, t)(start, u), half = held_step(plant, t / 2)(start, u);
    const PlantState halves = held_step(plant, t / 2)(half, u);
    INFO("case " << i);
    const double fast = std::sqrt(plant.stiffness_n_per_m / plant.mass_kg) + 1;  // velocities are so much larger
    CHECK(std::abs(whole.x_m - halves.x_m) < 1e-13);
    CHECK(std::abs(whole.v_m_per_s - halves.v_m_per_s) < 1e-13 * fast);
  }
}

TEST_CASE("what the force does is what the plant stores, a spring and a mass without damping") {
  const Plant plant = {0.15, 0, 300, 0};
  const HeldPlant device(plant, 1e-3);
  PlantState state = {0.01, 0.2};
  Random random(9);
  const auto energy = [&](const PlantState& s) {
    return (plant.mass_kg * s.v_m_per_s * s.v_m_per_s + plant.stiffness_n_per_m * s.x_m * s.x_m) / 2;
  };
  const double start = energy(state);
  double work = 0;
  for (int tick = 0; tick < 10'000; ++tick) {
    const double u = random.uniform(-5, 5);
    const PlantState next = device.after_tick(state, u);
    work += u * (next.x_m - state.x_m);
    state = next;
  }
  CHECK(energy(state) == Approx(start + work).epsilon(1e-11));
}

TEST_CASE("dry friction stops a sliding mass where it should, holds it, and lets a spring go by its limit") {
  const double v = 0.4, c = 0.5, m = 0.1;
  const HeldPlant sliding({m, 0, 0, c}, 1e-3);
  PlantState state = {0, v};
  for (int tick = 0; tick < 1000; ++tick)
    state = sliding.after_tick(state, 0);
  CHECK(state.v_m_per_s == 0);
  CHECK(state.x_m == Approx(m * v * v / 2 / c).epsilon(1e-12));
  const PlantState held = sliding.after_tick(state, 0.999 * c);
  CHECK(held.x_m == state.x_m);
  CHECK(sliding.after_tick(state, 1.001 * c).v_m_per_s > 0);
  // Every half swing a spring with dry friction loses 2 c / k of its amplitude.
  const double k = 200;
  const HeldPlant swinging({m, 0, k, c}, 0.9e-3);
  state = {0.1, 0};
  double turned_at = 0;
  for (int tick = 0; tick < 1000 && !(state.v_m_per_s > 0); ++tick) {
    state = swinging.after_tick(state, 0);
    turned_at = std::min(turned_at, state.x_m);
  }
  CHECK(turned_at == Approx(-(0.1 - 2 * c / k)).epsilon(1e-3));  // seen at ticks
}
