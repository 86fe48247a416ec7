// SPDX-License-Identifier: Apache-2.0
// Against the velocity: on the surface along it, in space in all directions.
#include "effect/effect_motion.hpp"

extern "C" void fdcg_viscosity_law(const fdcg_effect* effect, const fdcg_effect_facts*, fdcg_effect_state* state,
                                   double force_n[3]) {
  using namespace fdcg;
  Along v = vec(state->velocity_m_per_s);
  if (effect->when != FDCG_WHEN_ALWAYS) v = along_surface(v, *state);
  const Along force = v * -effect->viscosity_n_s_per_m;
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}
