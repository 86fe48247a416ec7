// SPDX-License-Identifier: Apache-2.0
#include "transport/device_identity.hpp"

#include <cmath>
#include <cstdio>

#include "fdcg_firmware.h"

namespace fdcg::dev {
namespace {

std::uint32_t load(const std::uint8_t* at, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i)
    value |= std::uint32_t{at[i]} << 8 * i;
  return value;
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string differs(const char* what, double device, double profile, const char* unit) {
  return std::string("the device's feature report says ") + what + " " + shown(device) + unit + ", the profile " +
         shown(profile) + unit + "; no force without a profile that fits";
}

constexpr double kMetresPerMm = 1e-3;
constexpr double kMost = 1 + 1e-6;  // of a ratio that is rounded on the device's side

// Positions: the counts of the first field of each axis.
std::string scale_problem(const Profile& profile, double counts_per_unit) {
  for (int i = 0; i < profile.input.field_count; ++i) {
    const Field& field = profile.input.fields[i];
    if (field.role != Role::kAxis || field.type == NumberType::kF32) continue;
    const double counts = 1 / std::fabs(field.scale);
    if (counts_per_unit > counts * kMost || counts > counts_per_unit * kMost)
      return differs("counts_per_unit", counts_per_unit, counts, "");
  }
  return {};
}

// The profile's box and forces lie within the device's.
std::string limit_problem(const Profile& profile, const std::uint8_t* data) {
  const bool is_cartesian = profile.kinematics.kind == KinematicsKind::kCartesian;
  const DeviceLimits& limits = profile.limits;
  for (int axis = 0; is_cartesian && axis < profile.axis_count; ++axis) {
    const double least = static_cast<std::int16_t>(load(data + 9 + 2 * axis, 2)) * kMetresPerMm;
    const double most = static_cast<std::int16_t>(load(data + 15 + 2 * axis, 2)) * kMetresPerMm;
    if (limits.workspace_min_m[axis] < least - kMetresPerMm)
      return differs("workspace_min", least, limits.workspace_min_m[axis], " m");
    if (limits.workspace_max_m[axis] > most + kMetresPerMm)
      return differs("workspace_max", most, limits.workspace_max_m[axis], " m");
  }
  const double peak = load(data + 21, 4) * 1e-3;
  if (is_cartesian && limits.force_n > peak * kMost) return differs("peak_force", peak, limits.force_n, " N");
  for (int axis = 0; axis < profile.axis_count; ++axis)
    if (limits.effort[axis] > peak * kMost)
      return differs("peak_force", peak, limits.effort[axis], is_cartesian ? " N" : " N m");
  const double watchdog_s = load(data + 31, 2) * 1e-3;
  if (limits.device_watchdog_s > 0 && (!(watchdog_s > 0) || watchdog_s > limits.device_watchdog_s * kMost))
    return differs("watchdog", watchdog_s, limits.device_watchdog_s, " s");
  return {};
}

}  // namespace

bool describes_itself(const Profile& profile) {
  return profile.match.usage_page == FDCG_FW_USAGE_PAGE && profile.match.usage == FDCG_FW_USAGE;
}

std::string identity_problem(const Profile& profile, const std::uint8_t* data, int bytes) {
  constexpr int kBytes = FDCG_FW_FEATURE_BYTES;
  if (bytes != kBytes || data[0] != FDCG_FW_FEATURE_ID)
    return "the device's feature report 3 is not that of the fdcg HID protocol (" + std::to_string(bytes) + " bytes; " +
           std::to_string(kBytes) + " expected)";
  if (load(data + kBytes - 2, 2) != fdcg_fw_crc16(data, kBytes - 2)) return "the device's feature report 3 has a wrong CRC";
  if (const std::uint32_t version = load(data + 1, 2); version != FDCG_FW_VERSION)
    return differs("version", version, FDCG_FW_VERSION, "");
  if (data[3] != profile.axis_count) return differs("dof", data[3], profile.axis_count, "");
  const bool is_cartesian = profile.kinematics.kind == KinematicsKind::kCartesian;
  if (data[4] != (is_cartesian ? FDCG_FW_CARTESIAN : FDCG_FW_ANGLES))
    return std::string("the device measures ") + (is_cartesian ? "angles" : "positions") + ", the profile reads " +
           (is_cartesian ? "positions" : "angles") + "; no force without a profile that fits";
  if (std::string problem = scale_problem(profile, load(data + 5, 4)); !problem.empty()) return problem;
  if (const std::uint32_t rate = load(data + 29, 2); rate != profile.rate_hz)
    return differs("rate", rate, profile.rate_hz, " Hz");
  return limit_problem(profile, data);
}

}  // namespace fdcg::dev
