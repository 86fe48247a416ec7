// SPDX-License-Identifier: Apache-2.0
// A tone. memory[0]: its phase, in turns.
#include "effect/effect_motion.hpp"
#include "effect/waves.hpp"

extern "C" void fdcg_vibration_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                   double force_n[3]) {
  using namespace fdcg;
  const double turns = effect->frequency_hz * facts->tick_s;
  if (!(turns < 0.5)) return;
  const Along force = direction_of(*effect, *state) * (effect->force_n * sine_of_turns(state->memory[0]));
  state->memory[0] += turns;
  if (state->memory[0] >= 1) state->memory[0] -= 1;
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}
