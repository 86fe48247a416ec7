// SPDX-License-Identifier: Apache-2.0
// A device made of numbers: a mass with damping, held by a hand (a spring and damper to a moving target), seen through quantised
// encoders, driven by the last force that it was sent. It speaks the reference protocol through the same firmware core that
// makers embed (runtime/device/firmware), watchdog included, so what is tried here is what a real one does.
#pragma once

#include <cstdint>

namespace fdcg::dev {

struct SimulationConfig {
  double rate_hz = 1000;
  double mass_kg = 0.1, damping_n_s_per_m = 0.5;
  double hand_stiffness_n_per_m = 200, hand_damping_n_s_per_m = 2;
  double quantum_m = 1e-5;                    // of the encoders
  double start_m[3] = {};                     // device's frame
  double amplitude_m[3] = {0, 0, 0.02};       // the hand's target swings about start_m
  double frequency_hz[3] = {1, 1, 0.5};
  bool is_real_time = true;                   // false: as fast as it is read
  std::uint64_t seed = 1;
};

}  // namespace fdcg::dev
