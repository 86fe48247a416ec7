// SPDX-License-Identifier: Apache-2.0
// What a host says of itself while it runs: copied out of the servo thread through a mailbox, printed by somebody else.
#pragma once

#include <cstdint>

#include "tick/device_tick.hpp"

namespace fdcg::dev {

// Times by powers of the fourth root of two, from 64 ns up: fixed size, one addition a value, quantiles within 19 %.
struct TimeHistogram {
  static constexpr int kBins = 128;
  std::uint64_t counts[kBins] = {};
  std::uint64_t total = 0, largest_ns = 0;
  void add(std::uint64_t ns);
  std::uint64_t quantile(double share) const;  // upper end of the bin, in ns; 0 where nothing was counted
};

enum class Connection : std::uint8_t { kAbsent = 0, kOpen = 1 };

struct DeviceStatus {
  Connection connection = Connection::kAbsent;
  std::uint64_t opened = 0;  // how often
  TickOutput last;
  TickCounters counters;
  std::uint64_t log_dropped = 0;  // ticks that found the log's ring full
  std::uint64_t writes = 0, write_failures = 0;
  double elapsed_s = 0;
  TimeHistogram interval, work, write;  // between good reports; of a tick, from drain to mailbox; of a write call
};

}  // namespace fdcg::dev
