// SPDX-License-Identifier: Apache-2.0
// A force towards the surface with a potential: over a closed path it gives what sampling gives, and no more.
#include "effect/effect_motion.hpp"

extern "C" void fdcg_magnet_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state*,
                                double force_n[3]) {
  using namespace fdcg;
  if (facts->is_touching != 0 || facts->has_surface == 0) return;
  constexpr double kPeak = 6.75;  // 1 over the largest s (1 - s)^2, which is at s = 1 / 3
  const Along away = vec(facts->hip_m) - vec(facts->surface_m);
  const double distance = norm(away), share = distance / effect->distance_m;
  if (!(share > 0 && share < 1)) return;
  const Along force = away * (-effect->force_n * kPeak * share * (1 - share) * (1 - share) / distance);
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}
