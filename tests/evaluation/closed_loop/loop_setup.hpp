// SPDX-License-Identifier: Apache-2.0
// A haptic loop of one degree of freedom: a device pressed against a wall that is felt at ticks, through an encoder, with
// delay.
#pragma once

#include "held_plant.hpp"

namespace fdcg::test {

struct LoopSetup {
  Plant plant;  // the device, with the hand that holds it
  double rate_hz = 1000;
  int delay_ticks = 0;                   // from the encoder's reading to the force
  double virtual_damping_n_s_per_m = 0;  // of the wall
  double quantum_m = 0;                  // of the encoder; 0: none

  [[nodiscard]] double tick_s() const { return 1 / rate_hz; }
};

constexpr int kMostDelay_ticks = 5;

}  // namespace fdcg::test
