// SPDX-License-Identifier: Apache-2.0
// White noise through a low pass and a high pass of first order, scaled to its root mean square. memory[0]: behind the low
// pass; memory[1]: what the high pass takes away.
#include "effect/effect_motion.hpp"
#include "effect/waves.hpp"

extern "C" void fdcg_noise_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                               double force_n[3]) {
  using namespace fdcg;
  constexpr double kTurn = 6.283185307179586476925, kRmsShare = 1.0 / 3;
  if (state->random == 0) state->random = first_noise(effect->seed);
  const double p = decay(kTurn * effect->frequency_hz * facts->tick_s), q = decay(kTurn * effect->low_hz * facts->tick_s);
  state->memory[0] = p * state->memory[0] + (1 - p) * next_noise(&state->random);
  state->memory[1] = q * state->memory[1] + (1 - q) * state->memory[0];
  // the variance behind both: that of an autoregressive series of second order, with a zero at frequency 0
  const double gain = (1 - p) * q * root(2 / ((1 - p * q) * (1 + p) * (1 + q)));
  if (!(gain > 0)) return;
  const double size = effect->force_n * kRmsShare / gain * (state->memory[0] - state->memory[1]);
  const Along force = direction_of(*effect, *state) * size;
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}
