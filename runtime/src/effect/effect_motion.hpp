// SPDX-License-Identifier: Apache-2.0
// What laws ask of a contact's motion.
#pragma once

#include "fdcg/effect.h"
#include "shared/vec.hpp"

namespace fdcg {

using Along = Vec3<double>;

// What of a vector lies in the surface; all of it where no surface is known.
inline Along along_surface(Along v, const fdcg_effect_state& state) {
  const Along normal = vec(state.normal);
  return v - normal * dot(normal, v);
}

// Unit, or zero where there is none.
inline Along direction_of(const fdcg_effect& effect, const fdcg_effect_state& state) {
  if (effect.along == FDCG_ALONG_NORMAL) return vec(state.normal);
  if (effect.along == FDCG_ALONG_AXIS) return vec(effect.axis);
  const Along v = along_surface(vec(state.velocity_m_per_s), state);
  const double speed = norm(v);
  return speed > 0 ? v * (1 / speed) : Along{0, 0, 0};
}

}  // namespace fdcg
