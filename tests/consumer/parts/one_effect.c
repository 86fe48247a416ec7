/* SPDX-License-Identifier: Apache-2.0 */
/* One effect and no contact: a hand over the plane z = 0 that this program computes itself. */
#include "fdcg/effect.h"

int main(void) {
  const fdcg_effect tone = fdcg_make_vibration(0.5, 250);
  fdcg_effect_state state = {0};
  fdcg_effect_facts facts = {0};
  double force_n[3] = {0, 0, 0};
  facts.tick_s = 0.001;
  facts.normal[2] = 1;
  facts.is_touching = 1;
  for (int tick = 0; tick < 10; ++tick)
    fdcg_effect_step(&tone, &facts, &state, force_n);
  return state.is_active == 1 && state.level == 1 ? 0 : 1;
}
