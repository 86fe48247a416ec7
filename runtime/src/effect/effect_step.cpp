// SPDX-License-Identifier: Apache-2.0
// What all effects have in common: motion, condition, limit, account.
#include "base/struct_bytes.hpp"
#include "effect/effect_motion.hpp"
#include "fdcg/effect.h"

namespace fdcg {
namespace {

constexpr double kFadingShare = 0.25;  // of the reserve: from here on the force fades

bool is_in_region(const fdcg_effect& effect, const double hip_m[3]) {
  if (effect.region == FDCG_EVERYWHERE) return true;
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double away = hip_m[k] - effect.region_m[k];
    if (effect.region == FDCG_IN_BOX && absolute(away) > effect.region_half_m[k]) return false;
    square += away * away;
  }
  return effect.region == FDCG_IN_BOX || square <= effect.region_half_m[0] * effect.region_half_m[0];
}

bool holds(const fdcg_effect& effect, const fdcg_effect_facts& facts, fdcg_effect_state* state) {
  if (effect.is_off != 0) return false;
  const bool is_known = facts.is_touching != 0 || facts.has_surface != 0;
  if (effect.material != FDCG_NONE && !(is_known && facts.material == effect.material)) return false;
  if (!is_in_region(effect, facts.hip_m)) return false;
  if (effect.when == FDCG_WHEN_TOUCHING) return facts.is_touching != 0;
  if (effect.when == FDCG_WHEN_SLIPPING) return facts.is_touching != 0 && facts.is_slipping != 0;
  if (effect.when == FDCG_WHEN_ALWAYS) return true;
  if (state->is_triggered == 0) return false;
  if (state->is_active != 0 && state->time_s >= effect.duration_s) state->is_triggered = 0;
  return state->is_triggered != 0;
}

// What the force of the last tick has given on the way since, and what may be given from now on.
void keep_account(const fdcg_effect& effect, double tick_s, Along way, fdcg_effect_state* state) {
  const double given = dot(vec(state->force_n), way);
  state->given_j += given;
  state->credit_j = smaller(state->credit_j - given + effect.power_w * tick_s, effect.reserve_j);
}

void move(const fdcg_effect& effect, const fdcg_effect_facts& facts, fdcg_effect_state* state) {
  const Along hip = vec(facts.hip_m);
  if (state->has_started == 0) {
    const fdcg_effect_state before = *state;
    *state = fdcg_effect_state{};
    state->is_triggered = before.is_triggered;
    state->given_j = before.given_j;
    state->has_started = 1;
    state->credit_j = effect.reserve_j;
  } else {
    const Along way = hip - vec(state->hip_m), velocity = vec(state->velocity_m_per_s);
    keep_account(effect, facts.tick_s, way, state);
    const double share = facts.tick_s / (facts.tick_s + effect.smoothing_s);
    store(way, state->way_m);
    store(velocity + (way * (1 / facts.tick_s) - velocity) * share, state->velocity_m_per_s);
  }
  store(hip, state->hip_m);
  if (facts.is_touching != 0 || facts.has_surface != 0) store(vec(facts.normal), state->normal);
}

// Faded in or out by a tick.
double ramped(double level, double target, double step) {
  if (level < target) return smaller(level + step, target);
  return larger(level - step, target);
}

// The law's force, made finite, no more than allowed.
Along limited(const fdcg_effect& effect, const fdcg_effect_state& state, Along force) {
  if (!is_usable(force)) return {0, 0, 0};
  double share = state.level;
  const double length = norm(force), fading = kFadingShare * effect.reserve_j;
  if (length > effect.force_n) share *= effect.force_n / length;
  if (state.credit_j < fading) share *= larger(state.credit_j, 0) / fading;
  return force * share;
}

bool is_usable(const fdcg_effect_facts& facts) {
  return facts.tick_s > 0 && facts.tick_s < RealLimits<double>::kFar && is_usable(vec(facts.hip_m)) &&
         is_usable(vec(facts.surface_m)) && is_usable(vec(facts.normal)) && is_usable(vec(facts.spring_n));
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_effect_init(fdcg_effect* effect, uint32_t struct_bytes) {
  fdcg_effect defaults = {};
  defaults.material = FDCG_NONE;
  defaults.axis[2] = 1;
  defaults.force_n = 1;
  defaults.reserve_j = 0.001;
  fdcg::fill_defaults(effect, defaults, struct_bytes);
}

extern "C" void fdcg_effect_step(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                 double force_n[3]) {
  using namespace fdcg;
  if (!is_usable(*facts) || effect->struct_bytes != sizeof *effect) {
    state->has_started = 0;
    return;
  }
  move(*effect, *facts, state);
  const bool was_active = state->is_active != 0, is_active = holds(*effect, *facts, state);
  state->has_begun = is_active && !was_active ? 1 : 0;
  state->is_active = is_active ? 1 : 0;
  state->time_s = state->has_begun != 0 ? 0 : state->time_s + facts->tick_s;
  const double step = effect->ramp_s > facts->tick_s ? facts->tick_s / effect->ramp_s : 1;
  state->level = ramped(state->level, is_active ? 1 : 0, step);
  Along force = {0, 0, 0};
  if (state->level > 0 && effect->law != nullptr) {
    double asked_n[3] = {0, 0, 0};
    effect->law(effect, facts, state, asked_n);
    force = limited(*effect, *state, vec(asked_n));
  }
  store(force, state->force_n);
  for (int k = 0; k < 3; ++k)
    force_n[k] += state->force_n[k];
}

extern "C" void fdcg_trigger_effect(fdcg_effect_state* state) {
  if (state == nullptr) return;
  state->is_triggered = 1;
  state->is_active = 0;
}
