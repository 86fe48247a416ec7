// SPDX-License-Identifier: Apache-2.0
// Limits for tests of the gate.
#pragma once

#include <cmath>

#include "profile/profile.hpp"

namespace fdcg::test {

inline dev::DeviceLimits sound_limits() {
  dev::DeviceLimits limits;
  limits.force_n = 3;
  for (double& effort : limits.effort)
    effort = 2.5;
  limits.slew_n_per_s = 500;
  limits.velocity_m_per_s = 1;
  for (int i = 0; i < 3; ++i) {
    limits.workspace_min_m[i] = -0.1;
    limits.workspace_max_m[i] = 0.1;
  }
  limits.device_watchdog_s = 0.02;
  return limits;
}

inline double norm(const double* v) {
  return std::hypot(v[0], v[1], v[2]);
}

}  // namespace fdcg::test
