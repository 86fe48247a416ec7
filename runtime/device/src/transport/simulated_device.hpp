// SPDX-License-Identifier: Apache-2.0
// A simulated device: a mass with damping, held by a hand (a spring and damper to a moving target), measured by quantised
// encoders and driven by the last force received. It uses the reference protocol through the same firmware core that makers
// embed (runtime/device/firmware), watchdog included, so that it behaves as a real device does.
//
// For tests it can inject faults (SimulatedFault) and record what it received (SimulationRecord).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "profile/profile.hpp"

namespace fdcg::dev {

enum class SimulatedFaultKind : std::uint8_t {
  kUnplug,   // for_s long; 0: for ever
  kRestart,  // the device resets: its sequence and clock restart
  kShort,    // half a report
  kLong,     // 16 bytes too many
  kGarbled,  // one to eight bits flipped
  kUnknownId,
  kRepeated,    // the report before, once more, instead of the new one
  kOutOfOrder,  // a report and the next one change places
  kStale,       // reports made in the next for_s arrive delay_s late, and those behind them not before
  kNotFinite,   // an axis is NaN: only of a device with has_float_axes
  kStall,       // no report for for_s; it still takes forces
  kNoOutput,    // takes no force for for_s: writes block until then, or fail after kWriteTimeoutS
  kDeviceFault  // reports a fault for for_s, without force meanwhile
};
inline constexpr int kSimulatedFaultKinds = 13;

struct SimulatedFault {
  SimulatedFaultKind kind = SimulatedFaultKind::kUnplug;
  double at_s = 0;  // since the device was first opened
  double for_s = 0;
  double delay_s = 0.02;
  int reports = 1;  // kShort to kOutOfOrder and kNotFinite: how many in a row, from the first one made at or after at_s
};

// The record of a run. Times are nanoseconds since the device was first opened. To be read after the host has stopped, except
// noticed_ns.
struct SimulationRecord {
  static constexpr int kMaxFaults = 256;
  static constexpr std::size_t kMaxForces = 1 << 20;
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};
  struct Force {
    std::uint64_t time_ns = 0;
    std::array<float, 3> force_n = {};
  };
  // The force that the motors had from each time on; up to kMaxForces changes, later ones are only counted.
  std::vector<Force> forces;
  std::uint64_t forces_not_kept = 0;
  float most_force_n = 0;          // the largest norm
  std::uint64_t verdicts[9] = {};  // of output reports, by fdcg_fw_verdict
  std::uint64_t watchdog_trips = 0;
  std::uint64_t reports = 0, reports_lost = 0;  // made; not read in time (64 are kept, newer ones lost)
  std::uint64_t origin_ns = 0, end_ns = 0;      // origin: on the host's clock (CLOCK_MONOTONIC; 0 in virtual time)
  // By the fault's index in SimulationConfig::faults: the first time at which the host could detect it (the read that returned
  // the first such report or the loss, the report that did not come, the write that blocked). kNever: not yet.
  std::atomic<std::uint64_t> noticed_ns[kMaxFaults];

  SimulationRecord();
  // The first time at or after from_ns at which the motors had no force; kNever: they never did.
  std::uint64_t zero_at(std::uint64_t from_ns) const;
  // The largest norm between the two times, both included.
  float most_force_between(std::uint64_t from_ns, std::uint64_t to_ns) const;
};

// The position of the hand's target at a time since the device was first opened, and the buttons pressed from then on. Between
// two steps it moves from rest to rest; before the first and after the last it does not move.
struct ScriptStep {
  double at_s = 0;
  double place_m[3] = {};     // device's frame
  std::uint32_t buttons = 0;  // bits 0 to 7
};

struct SimulationConfig {
  double rate_hz = 1000;
  double mass_kg = 0.1, damping_n_s_per_m = 0.5;
  double hand_stiffness_n_per_m = 200, hand_damping_n_s_per_m = 2;
  double quantum_m = 1e-5;               // of the encoders
  double start_m[3] = {};                // device's frame
  double amplitude_m[3] = {0, 0, 0.02};  // the hand's target swings about start_m
  double frequency_hz[3] = {1, 1, 0.5};
  static constexpr int kMaxScript = 256;
  std::vector<ScriptStep> script;  // in place of start and swing, which are then not read; times ascend
  // false: virtual time. Reads with a time-out advance the device's own clock, and writes never block: for tests that take
  // their time from the reports, since a host's threads run in real time.
  bool is_real_time = true;
  std::uint64_t seed = 1;
  double force_n = 10;  // that its motors can give
  double watchdog_s = 0.02;
  bool has_float_axes = false;               // positions as three floats in metres instead of counts
  std::vector<SimulatedFault> faults;        // up to SimulationRecord::kMaxFaults
  std::shared_ptr<SimulationRecord> record;  // null: nothing is written down
};

// How a host reads and drives the device of that configuration.
Profile simulated_profile(const SimulationConfig& config);

}  // namespace fdcg::dev
