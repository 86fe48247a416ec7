// SPDX-License-Identifier: Apache-2.0
// An independent check of the invariants of accepted profiles, on which the loop relies without checks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "profile/crc.hpp"
#include "profile/kinematics.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

// Null, or what is wrong.
inline const char* trouble_of(const ReportLayout& layout, Role numbers, int axis_count) {
  if (layout.bytes < 1 || layout.bytes > kMaxReportBytes) return "length of a report";
  if (layout.field_count > kMaxFields) return "number of fields";
  const int places = layout.is_text() ? layout.columns : 8 * layout.bytes;  // columns, or bits
  if (places > 8 * kMaxReportBytes || layout.columns > 32) return "number of columns";
  int owners[8 * kMaxReportBytes] = {};
  const auto claim = [&owners, places](int first, int count) {
    for (int i = first; i < first + count && i < places; ++i)
      ++owners[i];
    return first + count <= places;
  };
  const auto claim_field = [&](const Field& field) {
    if (layout.is_text()) return claim(field.offset, 1);
    const int bits = 8 * bytes_of(field.type);
    if (field.bits > bits || field.bit > 7 || (field.bits != 0 && field.is_big_endian)) return false;
    return field.bits != 0 ? claim(8 * field.offset + field.bit, field.bits) : claim(8 * field.offset, bits);
  };
  if (layout.is_text() && (layout.id != 0 || layout.crc.kind != CrcKind::kNone)) return "an id or a checksum of text";
  if (layout.id != 0) claim(0, 8);
  int axes[kMaxAxes] = {};
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    if (!claim_field(field)) return "a field beyond the report";
    if (!std::isfinite(1 / field.scale) || !std::isfinite(field.bias)) return "a field's scale or bias";
    if (field.axis >= kMaxAxes) return "a field's axis";
    if (field.role == numbers) ++axes[field.axis];
    const bool is_number = field.role == Role::kAxis || field.role == Role::kEffort;
    if (!is_number && (field.constant & ~mask_of(field)) != 0) return "a field's value";
  }
  const Crc& crc = layout.crc;
  if (crc.kind != CrcKind::kNone && (!claim(8 * crc.offset, 8 * bytes_of(crc.kind)) || crc.first + crc.bytes > layout.bytes))
    return "a checksum beyond the report";
  if (*std::max_element(owners, owners + places) > 1) return "fields that overlap";
  for (int axis = 0; axis < kMaxAxes; ++axis) {
    if (axes[axis] != (axis < axis_count ? 1 : 0)) return "axes that are missing or stand twice";
  }
  return nullptr;
}

inline const char* trouble_of(const DeviceLimits& limits) {
  for (const double limit : {limits.force_n, limits.effort[0], limits.effort[1], limits.effort[2], limits.slew_n_per_s,
                             limits.velocity_m_per_s, limits.device_watchdog_s}) {
    if (!std::isfinite(limit) || limit < 0) return "a limit";
  }
  for (int i = 0; i < 3; ++i) {
    const double least = limits.workspace_min_m[i], most = limits.workspace_max_m[i];
    if (!std::isfinite(least) || !std::isfinite(most) || least > most) return "the workspace";
  }
  return nullptr;
}

inline const char* trouble_of(const Profile& profile) {
  if (std::memchr(profile.name, '\0', kProfileNameBytes) == nullptr) return "a name without end";
  if (!(profile.rate_hz >= 1 && profile.rate_hz <= 100000)) return "the rate";
  if (!axis_count_fits(profile.kinematics.kind, profile.axis_count)) return "the number of axes";
  if (profile.init_count > kMaxFixedReports || profile.safe_stop_count > kMaxFixedReports) return "too many fixed reports";
  for (int i = 0; i < kMaxFixedReports; ++i) {
    if (profile.init[i].bytes > kMaxReportBytes || profile.safe_stop[i].bytes > kMaxReportBytes) return "a long fixed report";
  }
  for (const double length_m : profile.kinematics.lengths_m) {
    if (!std::isfinite(length_m)) return "a length";
  }
  if (const char* trouble = trouble_of(profile.limits)) return trouble;
  if (const char* trouble = trouble_of(profile.input, Role::kAxis, profile.axis_count)) return trouble;
  return profile.has_output ? trouble_of(profile.output, Role::kEffort, profile.axis_count) : nullptr;
}

}  // namespace fdcg::dev
