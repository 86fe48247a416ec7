// SPDX-License-Identifier: Apache-2.0
// Where a moving object is, as a function of the time since the host started. A spin turns it about an axis of the world through
// the origin of the object's frame; a swing moves it to and fro along a direction of the world, from its pose at the start.
#pragma once

#include <cmath>

#include "host_config.hpp"

namespace fdcg::dev {

inline fdcg_pose moved_pose(const fdcg_pose& start, const Motion& motion, double seconds) {
  constexpr double kTurn = 6.283185307179586;
  fdcg_pose pose = start;
  if (motion.kind == MotionKind::kSpin) {
    const double turns = motion.rate_hz * seconds;
    const double half = kTurn / 2 * (turns - std::floor(turns));  // small: a host may run for days
    const double s = std::sin(half), c = std::cos(half);
    const double a[3] = {s * motion.axis[0], s * motion.axis[1], s * motion.axis[2]};
    const double* q = start.rotation_xyzw;
    pose.rotation_xyzw[0] = c * q[0] + a[0] * q[3] + a[1] * q[2] - a[2] * q[1];
    pose.rotation_xyzw[1] = c * q[1] + a[1] * q[3] + a[2] * q[0] - a[0] * q[2];
    pose.rotation_xyzw[2] = c * q[2] + a[2] * q[3] + a[0] * q[1] - a[1] * q[0];
    pose.rotation_xyzw[3] = c * q[3] - a[0] * q[0] - a[1] * q[1] - a[2] * q[2];
  } else if (motion.kind == MotionKind::kSwing) {
    const double swings = motion.rate_hz * seconds;
    const double along_m = motion.amplitude_m * std::sin(kTurn * (swings - std::floor(swings)));
    for (int i = 0; i < 3; ++i) pose.translation_m[i] += along_m * motion.axis[i];
  }
  return pose;
}

}  // namespace fdcg::dev
