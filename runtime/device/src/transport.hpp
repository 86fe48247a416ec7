// SPDX-License-Identifier: Apache-2.0
// The way to a device: HID, simulated or recorded. One reader thread and one writer thread use it, at the same time; open and
// close belong to a third, the supervisor, and never run while one of the two is inside.
#pragma once

#include <cstdint>
#include <string>

#include "profile.hpp"

namespace fdcg::dev {

enum class ReadStatus : std::uint8_t { kReport = 0, kTimeout = 1, kLost = 2 };
struct ReadResult {
  ReadStatus status = ReadStatus::kTimeout;
  int bytes = 0;
};

class Transport {
 public:
  virtual ~Transport() = default;
  // Supervisor's. An empty string is success; otherwise why not, and what to do, for the user. May take as long as it needs.
  virtual std::string open() = 0;
  virtual void close() = 0;
  // Reader's. Waits up to timeout_ms (0: not at all) for the oldest report not yet read. Allocates nothing while all is well.
  virtual ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) = 0;
  // Writer's. May block (a device that does not take output: 5 s). False: the device is lost.
  virtual bool write(const std::uint8_t* data, int bytes) = 0;
  virtual bool write_feature(const std::uint8_t* data, int bytes) = 0;
};

}  // namespace fdcg::dev
