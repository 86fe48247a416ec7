// SPDX-License-Identifier: Apache-2.0
// The hand is moved along the normal by the height under it, and the step's force comes back through the transposed derivative
// of that move.
#include "fdcg/relief.h"

#include "base/struct_bytes.hpp"
#include "effect/effect_motion.hpp"

namespace fdcg {
namespace {

constexpr double kFadingHeights = 0.25;  // of the reserve: from here on the heights fade
constexpr double kKnees = 8;  // so many largest heights deep they are felt in full; from 7 on force only rises with depth

// How far heights are felt at a depth, and its derivative: a smooth step.
struct GrownIn {
  double share, per_m;
};
GrownIn grown_in(double depth_m, double knee_m) {
  if (depth_m >= knee_m) return {1, 0};
  const double s = depth_m / knee_m;
  return {s * s * (3 - 2 * s), 6 * s * (1 - s) / knee_m};
}

// Heights as they are felt.
struct Felt {
  double height_m;
  Along slope;
};
constexpr Felt kFlat = {0, {0, 0, 0}};

// For this place of the hand; `way`: since the last tick.
FDCG_HOT Felt look(const fdcg_relief& relief, const fdcg_relief_state& state, Along hip, Along way) {
  if (state.has_surface == 0 || relief.is_off != 0) return kFlat;
  const Along normal = vec(state.normal);
  const double depth = dot(vec(state.surface_m) - hip, normal);
  if (!(depth > 0)) return kFlat;
  const double fading = kFadingHeights * relief.reserve_j;
  double slope[3] = {0, 0, 0}, height_m = 0;
  fdcg_relief_place place;
  store(hip + normal * depth, place.place_m);
  store(way - normal * dot(way, normal), place.way_m);
  place.node = state.node;
  place.reserved = 0;
  relief.law(&relief, &place, &height_m, slope);
  const Along rise = vec(slope);
  if (!is_usable(rise) || !(absolute(height_m) <= relief.most_m)) return kFlat;
  const Along along = rise - normal * dot(rise, normal);
  const double knee = kKnees * relief.most_m;
  if (depth >= knee && state.credit_j >= fading) return {height_m, along};  // felt in full
  const double share = state.credit_j < fading ? larger(state.credit_j, 0) / fading : 1;
  const GrownIn in = grown_in(depth, knee);
  return {share * in.share * height_m, along * (share * in.share) - normal * (share * in.per_m * height_m)};
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_relief_init(fdcg_relief* relief, uint32_t struct_bytes) {
  fdcg_relief defaults = {};
  defaults.material = FDCG_NONE;
  defaults.reserve_j = 0.002;
  defaults.power_w = 0.02;
  fdcg::fill_defaults(relief, defaults, struct_bytes);
}

extern "C" void fdcg_relief_move(const fdcg_relief* relief, fdcg_relief_state* state, const double hip_m[3], double tick_s,
                                 double moved_m[3]) {
  using namespace fdcg;
  const Along hip = {hip_m[0], hip_m[1], hip_m[2]};
  if (!is_usable(hip) || relief->struct_bytes != sizeof *relief) {
    *state = fdcg_relief_state{};
    for (int k = 0; k < 3; ++k)
      moved_m[k] = hip_m[k];
    return;
  }
  const bool goes_on = state->has_started != 0;
  if (!goes_on) state->credit_j = relief->reserve_j;
  const Along way = goes_on ? hip - vec(state->hip_m) : kFlat.slope;
  const Felt felt = look(*relief, *state, hip, way);
  const Along moved = hip - vec(state->normal) * felt.height_m;
  if (goes_on) {  // what the relief has given since, beyond the step
    const double given = dot(vec(state->force_n), way) - dot(vec(state->flat_n), moved - vec(state->moved_m));
    state->given_j += given;
    state->credit_j = smaller(state->credit_j - given + relief->power_w * tick_s, relief->reserve_j);
  }
  state->has_started = 1;
  state->height_m = felt.height_m;
  store(felt.slope, state->slope);
  store(hip, state->hip_m);
  store(moved, state->moved_m);
  for (int k = 0; k < 3; ++k)
    moved_m[k] = state->moved_m[k];
}

extern "C" void fdcg_relief_turn(const fdcg_relief* relief, fdcg_relief_state* state, const fdcg_effect_facts* facts,
                                 double force_n[3]) {
  using namespace fdcg;
  const Along flat = {force_n[0], force_n[1], force_n[2]};
  const Along force = flat - vec(state->slope) * dot(flat, vec(state->normal));
  store(flat, state->flat_n);
  store(force, state->force_n);
  const bool is_of_material = relief->material == FDCG_NONE || facts->material == relief->material;
  state->has_surface = facts->is_touching != 0 && is_of_material ? 1 : 0;
  state->node = facts->node;
  store(vec(facts->surface_m), state->surface_m);
  if (state->has_surface != 0) store(vec(facts->normal), state->normal);
  for (int k = 0; k < 3; ++k)
    force_n[k] = state->force_n[k];
}
