// SPDX-License-Identifier: Apache-2.0
// A spring to an anchor. The anchor only ever moves nearer to the hand (down the normal, or all the way where it slips): what
// the spring stores is lost then, so the effect gives nothing but sampling's share. memory[0] to [2]: the anchor.
#include "effect/effect_motion.hpp"

extern "C" void fdcg_stick_slip_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                    double force_n[3]) {
  using namespace fdcg;
  const Along hip = vec(facts->hip_m);
  Along stretch = hip - Along{state->memory[0], state->memory[1], state->memory[2]};
  if (effect->when != FDCG_WHEN_ALWAYS) stretch = along_surface(stretch, *state);
  if (state->has_begun != 0 || effect->stiffness_n_per_m * norm(stretch) > effect->force_n) stretch = {0, 0, 0};
  const Along anchor = hip - stretch, force = stretch * -effect->stiffness_n_per_m;
  state->memory[0] = anchor.x, state->memory[1] = anchor.y, state->memory[2] = anchor.z;
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}
