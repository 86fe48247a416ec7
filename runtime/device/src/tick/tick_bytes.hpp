// SPDX-License-Identifier: Apache-2.0
// Serialisation of a tick's input and output in a session's log (schemas/session-log.md). Little-endian; only the reports that
// were read, only the parts of the output that are not all zero. No heap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "tick/device_tick.hpp"

namespace fdcg::dev {

inline constexpr std::size_t kMostInputBytes = 56 + kMaxDriven * sizeof(fdcg_pose) + kMaxDrain * (10 + kMaxReportBytes);
inline constexpr std::size_t kBodyBytes = 56;  // rotation and translation
inline constexpr std::size_t kMostOutputBytes = 232 + 1 + kMaxBodies * kBodyBytes;
inline constexpr std::size_t kMostTickBytes = kMostInputBytes + kMostOutputBytes;

// A TickOutput read from a log: only the gate creates a GatedForce, so this has plain numbers.
struct LoggedOutput {
  double effort[kMaxAxes] = {};
  double force_n[3] = {};
  bool is_enabled = false, arming_refused = false, has_sample = false;
  std::uint8_t phase = 0, fault = 0;
  std::uint32_t echo = 0, state = 0;
  double hip_world_m[3] = {};
  double wanted_force_n[3] = {};
  Sample sample;
  double round_trip_s = 0, calmed = 0, damping_n_s_per_m = 0;
  bool is_hot = false;
  std::uint8_t body_count = 0;
  fdcg_pose bodies[kMaxBodies] = {};  // but for their scales, which the scene has
};
LoggedOutput logged(const TickOutput& output);
// The same into one that is there; its bodies beyond the count are not touched.
void log_output(const TickOutput& output, LoggedOutput* plain);

// Both return the number of bytes written, at most kMostInputBytes and kMostOutputBytes.
std::size_t encode_tick_input(const TickInput& input, std::uint8_t* to);
std::size_t encode_tick_output(const LoggedOutput& output, std::uint8_t* to);

// The number of bytes read, or 0 where they are invalid: too few, or a count or a code beyond its limit. *input's reports and
// poses beyond the counts are not changed.
std::size_t decode_tick_input(const std::uint8_t* from, std::size_t bytes, TickInput* input);
std::size_t decode_tick_output(const std::uint8_t* from, std::size_t bytes, LoggedOutput* output);

// "force_n[2]: 1.25 in the log, 1.5 in the replay": the first field whose bits differ; empty: none.
std::string first_difference(const LoggedOutput& in_log, const LoggedOutput& in_replay);

}  // namespace fdcg::dev
