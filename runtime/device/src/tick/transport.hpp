// SPDX-License-Identifier: Apache-2.0
// The interface to a device: HID, simulated or recorded. One reader thread and one writer thread use it concurrently; a third,
// the supervisor, opens and closes it, never while one of the two is inside.
//
// Reports are the bytes that the profile lays out: the first is the report id where the device has ids, and data where it has
// none (profile.hpp).
#pragma once

#include <cstdint>
#include <string>

#include "profile/profile.hpp"

namespace fdcg::dev {

enum class ReadStatus : std::uint8_t { kReport = 0, kTimeout = 1, kLost = 2 };
struct ReadResult {
  ReadStatus status = ReadStatus::kTimeout;
  int bytes = 0;
};

// Zero force where a thread hangs, and in a process that is ending: async-signal-safe. It is given an output report, of zero
// force or of the profile's safe stop. Null: there is none.
struct EmergencyCall {
  void (*call)(void* self, const std::uint8_t* report, int bytes) = nullptr;
  void* self = nullptr;
};

class Transport {
 public:
  virtual ~Transport() = default;
  // Supervisor's. An empty string is success; otherwise why not, and what to do, for the user. May take as long as it needs.
  virtual std::string open() = 0;
  // Supervisor's. No effect if nothing is open.
  virtual void close() = 0;
  // Supervisor's, after a loss: true where there is nothing more to come (a recording's end), so that opening again is no use.
  virtual bool is_over() const { return false; }
  // Of a device that is not in real time (a simulated or a recorded one, without real_time): its own clock, which only its
  // reads and openings carry forward, from 0 at its first opening. Others: 0.
  virtual std::uint64_t clock_ns() const { return 0; }
  // Reader's. Waits up to timeout_ms (0: not at all) for the oldest report not yet read. Allocates nothing while all is well.
  virtual ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) = 0;
  // Writer's. May block (a device that does not take output: 5 s). False: the device did not take it, or is lost.
  virtual bool write(const std::uint8_t* data, int bytes) = 0;
  virtual bool write_feature(const std::uint8_t* data, int bytes) = 0;
  // Any thread's while it is open: a file descriptor that accepts output reports by write(2), for crash handlers
  // (emergency.hpp); -1: there is none.
  virtual int emergency_descriptor() const { return -1; }
  // The same by a function of the device's own.
  virtual EmergencyCall emergency_call() const { return {}; }
};

}  // namespace fdcg::dev
