// SPDX-License-Identifier: Apache-2.0
// What the device host counts and reports: names, counters and times. Plain values, shared by the host's own rooms and by the
// programs that show them (device_tools.hpp). Not installed: fdcg/device.h is the interface for everybody else.
#pragma once

#include <cstdint>
#include <string>

namespace fdcg::dev {

inline constexpr int kAllDevices = -1;

// Why a report is not used. Names are part of the log and of the status: never renumber.
enum class Verdict : std::uint8_t {
  kGood = 0,
  kLength = 1,
  kId = 2,
  kCrc = 3,
  kConstant = 4,  // a byte that never changes has changed
  kNotFinite = 5,
  kRepeated = 6,    // the sequence number of the report before
  kOutOfOrder = 7,  // one from before that
  kStale = 8,       // too old by the device's own clock
};
inline constexpr int kVerdicts = 9;

// Why there is no force. Part of the log and the status: never renumber.
enum class Fault : std::uint8_t {
  kNone = 0,
  kUnknownLimit = 1,  // the profile lacks a limit of the device or the hand: never armed
  kSilence = 2,
  kWriterStuck = 3,
  kWriteFailed = 4,
  kReadFailed = 5,  // unplugged
  kNotFinite = 6,   // a number of our own
  kWorkspace = 7,   // the tip is where the device cannot be
  kSpeed = 8,
  kHostLate = 9,      // the host itself was away for kSilenceS or more
  kDeviceFault = 10,  // the device says so itself
  kCommanded = 11,    // disarmed by the user
  kClock = 12,        // the host's clock went back
  kSlept = 13,        // the whole computer was suspended
  kNotTaken = 14,     // the device does not take what the host sends, or does not apply it
  kOtherHost = 15,    // it answers what somebody else sends
  kRestarted = 16,    // the device began anew
  kReportsLost = 17,  // too many of its reports do not arrive
  kLag = 18,          // asked to arm: what is sent comes back too late
  kShaking = 19,      // and softer forces have not ended it
  kReleased = 20,     // the dead-man button is not held
};
inline constexpr int kFaults = 21;
const char* fault_name(Fault fault);  // "silence"
const char* fault_text(Fault fault);  // one line: what happened and what to do

enum class Phase : std::uint8_t { kDisarmed = 0, kRamping = 1, kArmed = 2, kFading = 3 };

// Of one device, since the start.
struct TickCounters {
  std::uint64_t ticks = 0;       // with a good report
  std::uint64_t late = 0;        // more than 1.5 periods after the one before
  std::uint64_t lost = 0;        // gaps in the device's sequence, in reports
  std::uint64_t superseded = 0;  // good, but a newer one was there
  std::uint64_t rejected[kVerdicts] = {};
  std::uint64_t timeouts = 0;
  std::uint64_t disarmed[kFaults] = {};
  std::uint64_t bodies_lost = 0;  // 1: the runtime refused to move a body (beyond 1e12 m), and all have stood still since
};

// Times by powers of the fourth root of two, from 64 ns up: fixed size, one addition a value, quantiles within 19 %.
struct TimeHistogram {
  static constexpr int kBins = 128;
  std::uint64_t counts[kBins] = {};
  std::uint64_t total = 0, largest_ns = 0;
  void add(std::uint64_t ns);
  static std::uint64_t upper_end_ns(int bin);  // a time that is equal to it belongs to the next bin
  std::uint64_t quantile(double share) const;  // upper end of the bin, in ns; 0 where nothing was counted
};

// The longest round trip with which a device is armed, from a write to its echo.
double most_round_trip_s(double rate_hz);

enum class Connection : std::uint8_t { kAbsent = 0, kOpen = 1 };

// Of one device, when a session's log has been replayed.
struct DeviceReplay {
  std::string name;
  std::uint64_t ticks = 0;  // replayed, the one that differs included
  std::string difference;   // of the first tick that is not the same; empty: none
  bool is_over = false;     // it came to a difference or a gap
  bool has_gap = false;
  std::uint64_t gap_at = 0;  // the first tick that the log lacks
  std::string ended_by;      // the device that shares its scene and came to a difference; empty: none
};

}  // namespace fdcg::dev
