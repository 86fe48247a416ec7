// SPDX-License-Identifier: Apache-2.0
// Half a sine, again after each period. memory[0]: time since the last one began.
#include "effect/effect_motion.hpp"
#include "effect/waves.hpp"

extern "C" void fdcg_pulse_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                               double force_n[3]) {
  using namespace fdcg;
  state->memory[0] = state->has_begun != 0 ? 0 : state->memory[0] + facts->tick_s;
  if (effect->period_s > 0 && state->memory[0] >= effect->period_s)
    state->memory[0] = smaller(state->memory[0] - effect->period_s, effect->period_s);
  if (!(state->memory[0] < effect->duration_s)) return;
  const double size = effect->force_n * sine_of_turns(0.5 * state->memory[0] / effect->duration_s);
  const Along force = direction_of(*effect, *state) * size;
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}
