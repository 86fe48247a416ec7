// SPDX-License-Identifier: Apache-2.0
// A decaying tone at first contact. memory[0]: its phase, in turns; memory[1]: what is left of its amplitude, in newtons.
#include "effect/effect_motion.hpp"
#include "effect/waves.hpp"

extern "C" void fdcg_tap_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                             double force_n[3]) {
  using namespace fdcg;
  const double turns = effect->frequency_hz * facts->tick_s;
  if (!(turns < 0.5)) return;
  const Along normal = vec(state->normal);
  if (state->has_begun != 0) {
    const double impact_m_per_s = -dot(vec(state->velocity_m_per_s), normal);
    state->memory[0] = 0;
    state->memory[1] = smaller(effect->impact_n_s_per_m * larger(impact_m_per_s, 0), effect->force_n);
  }
  const Along force = normal * (state->memory[1] * sine_of_turns(state->memory[0]));
  state->memory[0] += turns;
  if (state->memory[0] >= 1) state->memory[0] -= 1;
  state->memory[1] *= decay(facts->tick_s / effect->decay_s);
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}
