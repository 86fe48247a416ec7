// SPDX-License-Identifier: Apache-2.0
// The fault script of a simulated device: the duration of each fault, and its effect on reports. Times are nanoseconds since
// the device was first opened.
#pragma once

#include <memory>
#include <vector>

#include "transport/simulated_device.hpp"

namespace fdcg::dev {

// A report on its way to the host.
struct SimulatedPacket {
  std::uint64_t arrival_ns = 0;
  int bytes = 0;
  int fault = -1;  // the index of the fault that changed it
  std::uint8_t data[kMaxReportBytes] = {};
};

class SimulatedFaults {
 public:
  explicit SimulatedFaults(const SimulationConfig& config);

  // For any thread: they only read the script.
  static constexpr int kNone = -1;
  int lasting(SimulatedFaultKind kind, std::uint64_t time_ns) const;  // the first of that kind that lasts then, or kNone
  std::uint64_t begin_ns(int fault) const;
  std::uint64_t end_ns(int fault) const;                      // of an unplugging without end: kNever
  std::uint64_t unplugged_at(std::uint64_t opened_ns) const;  // when a device that was opened then is lost
  void notice(int fault, std::uint64_t time_ns) const;        // into the record, the first time
  void notice_unplugging(std::uint64_t time_ns) const;        // every one that has begun

  // The reader's.
  bool restarts(std::uint64_t time_ns);  // once for each restart whose time has come
  // Applies faults to the report made at its arrival_ns. True: it is to be swapped with the next.
  bool touch(SimulatedPacket* packet);

 private:
  void damage(const SimulatedFault& fault, SimulatedPacket* packet);
  void not_a_number(SimulatedPacket* packet);
  std::uint64_t random();

  std::vector<SimulatedFault> faults_;
  std::shared_ptr<SimulationRecord> record_;
  bool has_float_axes_;
  std::uint64_t random_;
  std::vector<int> left_;  // reports that each is still to touch
  int restarted_by_ = kNone;
  SimulatedPacket last_;  // as it was made
};

}  // namespace fdcg::dev
