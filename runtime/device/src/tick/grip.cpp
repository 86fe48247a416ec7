// SPDX-License-Identifier: Apache-2.0
#include "tick/grip.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"

namespace fdcg::dev {
namespace {

double moved(const HeldButton& button, std::uint32_t buttons, double period_s, double share) {
  if (button.mask == 0) return 0;
  const double step = period_s / button.seconds;
  return std::clamp((buttons & button.mask) != 0 ? share + step : share - step, 0.0, 1.0);
}

// Smoothstep: a jump of the speed at either end would be an impact on the held object.
double smooth(double share) {
  return share * share * (3 - 2 * share);
}

}  // namespace

void move_grip(const Grip& grip, std::uint32_t buttons, double period_s, GripState* state) {
  state->closed = moved(grip.close, buttons, period_s, state->closed);
  state->turned = moved(grip.turn, buttons, period_s, state->turned);
}

void grip_turn(const Grip& grip, const GripState& state, double turn_xyzw[4]) {
  // Between no turn and the whole one on the straight line, made of length 1 again: up to half a turn, without sine or cosine.
  const double part = smooth(state.turned), *const whole = grip.turn_xyzw;
  const double q[4] = {whole[0] * part, whole[1] * part, whole[2] * part, 1 + (whole[3] - 1) * part};
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int i = 0; i < 4; ++i)
    turn_xyzw[i] = q[i] / length;
}

void grip_offset(const Grip& grip, const GripState& state, int contact, const double open_m[3], double offset_m[3]) {
  const double share = smooth(state.closed);
  double at_m[3] = {open_m[0], open_m[1], open_m[2]};
  if (share > 0) {
    for (int i = 0; i < 3; ++i)
      at_m[i] += (grip.closed_m[contact][i] - open_m[i]) * share;
  }
  std::copy_n(at_m, 3, offset_m);
  if (!(state.turned > 0)) return;
  double q[4];
  grip_turn(grip, state, q);
  turn(q, at_m, offset_m);
}

}  // namespace fdcg::dev
