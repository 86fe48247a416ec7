// SPDX-License-Identifier: Apache-2.0
// A device for tests, as a table made by hand.
#pragma once

#include <algorithm>

#include "profile/profile.hpp"

namespace fdcg::test {

// Three positions, a sequence number, the device's clock in microseconds, a status byte (bit 0: a fault); three floats out.
inline dev::Profile plain_profile(double quantum_m = 1e-6) {
  using namespace dev;
  Profile profile;
  profile.rate_hz = 1000;
  profile.axis_count = 3;
  profile.has_output = true;
  profile.input.id = 1;
  profile.input.bytes = 22;
  const auto add = [](ReportLayout& layout, Role role, NumberType type, int offset, double scale, int axis = 0) {
    Field& field = layout.fields[layout.field_count++];
    field.role = role;
    field.type = type;
    field.offset = static_cast<std::uint16_t>(offset);
    field.scale = scale;
    field.axis = static_cast<std::uint8_t>(axis);
  };
  for (int axis = 0; axis < 3; ++axis)
    add(profile.input, Role::kAxis, NumberType::kI32, 1 + 4 * axis, quantum_m, axis);
  add(profile.input, Role::kSequence, NumberType::kU32, 13, 1);
  add(profile.input, Role::kTime, NumberType::kU32, 17, 1e-6);
  add(profile.input, Role::kStatus, NumberType::kU8, 21, 1);
  profile.input.fields[profile.input.field_count - 1].constant = 1;
  profile.output.id = 2;
  profile.output.bytes = 13;
  for (int axis = 0; axis < 3; ++axis)
    add(profile.output, Role::kEffort, NumberType::kF32, 1 + 4 * axis, 1, axis);
  DeviceLimits& limits = profile.limits;
  limits.force_n = 5;
  std::fill_n(limits.effort, 3, 5.0);
  limits.slew_n_per_s = 1e5;
  limits.velocity_m_per_s = 10;
  std::fill_n(limits.workspace_min_m, 3, -2.0);
  std::fill_n(limits.workspace_max_m, 3, 2.0);
  limits.device_watchdog_s = 0.02;
  return profile;
}

}  // namespace fdcg::test
