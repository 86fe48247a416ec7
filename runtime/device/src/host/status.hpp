// SPDX-License-Identifier: Apache-2.0
// What a host says of itself while it runs: copied out of the servo thread through a mailbox, printed by somebody else.
#pragma once

#include <cstdint>

#include "fdcg/device_status.hpp"
#include "tick/device_tick.hpp"

namespace fdcg::dev {

struct DeviceStatus {
  Connection connection = Connection::kAbsent;
  std::uint64_t opened = 0;  // how often
  TickOutput last;
  TickCounters counters;
  std::uint64_t log_dropped = 0;  // ticks that found the log's ring full
  std::uint64_t writes = 0, write_failures = 0;
  double elapsed_s = 0;
  TimeHistogram interval, work, write;  // between good reports; of a tick, from drain to mailbox; of a write call
  TimeHistogram round_trip;             // from the write of an output to its echo
};

// A servo thread that hangs writes no new status. Turns a status older than kStandstillS, now_s after the start, into what
// holds then: no force, since the writer sends zero by itself, and disarmed, as the thread will be when it runs again.
inline constexpr double kStandstillS = 0.25;
void tell_standstill(double now_s, DeviceStatus* status);

}  // namespace fdcg::dev
