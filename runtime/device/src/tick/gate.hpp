// SPDX-License-Identifier: Apache-2.0
// The safety gate: the last stage before the device. Only the gate creates a GatedForce, the only type that a writer accepts. A
// pure function: the time is an argument. No heap, no lock, bounded work.
//
// Its output is finite; its norm is at most force_n; its efforts are at most effort[] each; and it is a force within the slew
// limit of the last one, or such a force scaled down: it may go to zero at once. Not armed, or after a fault: zero.
//
// Arming needs a command and near zero force; the force is then ramped up over kRampS. After kMissedTicksToFade periods without
// a good report it fades to zero within kFadeS, and is ramped up again when reports return. Every other fault disarms at once,
// until the next command.
#pragma once

#include <cstdint>

#include "fdcg/device_status.hpp"
#include "profile/kinematics.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

inline constexpr int kMissedTicksToFade = 3;
inline constexpr double kFadeS = 0.0015;             // from any force to zero
inline constexpr double kRampS = 0.5;                // from zero to full after arming
inline constexpr double kWriterStuckS = 0.005;       // in one write: disarmed
inline constexpr double kArmForceShare = 0.05;       // of force_n: arming is granted only below it
inline constexpr double kForceWithoutWatchdogN = 1;  // the most for a device that does not drop its force by itself ...
inline constexpr double kLongestWatchdogS = 0.1;     // ... within this

// Whether no limit is missing: where one is, the gate gives no force.
bool are_known(const DeviceLimits& limits, int axis_count, double rate_hz);

// Zero, or what the gate has let through.
class GatedForce {
 public:
  GatedForce() = default;
  const double* effort() const { return effort_; }    // kMaxAxes: N or N m
  const double* force_n() const { return force_n_; }  // 3, device's frame
  bool is_enabled() const { return is_enabled_; }     // the gate is armed

 private:
  friend class Gate;
  double effort_[kMaxAxes] = {};
  double force_n_[3] = {};
  bool is_enabled_ = false;
};

struct GateInput {
  std::uint64_t now_ns = 0;
  std::uint64_t slept_ns = 0;  // for which the computer has been suspended since it was started
  bool has_sample = false;     // a good report came in this tick; tip is of it
  TipPose tip;
  bool is_tip_valid = true;
  double wanted_force_n[3] = {};     // device's frame
  bool arm = false, disarm = false;  // commands
  bool device_fault = false;
  Fault link_fault = Fault::kNone;  // of LinkWatch
  bool lags = false;                // of LinkWatch: no arming
  bool read_failed = false, write_failed = false;
  std::uint64_t write_busy_ns = 0;  // for how long the write in progress has been going on
};

class Gate {
 public:
  // The profile's limits, no larger than `most` where that is above 0 (the scene's), and with kForceWithoutWatchdogN.
  void begin(const DeviceLimits& limits, int axis_count, double rate_hz, double most_force_n);
  GatedForce step(const GateInput& input);

  Phase phase() const { return phase_; }
  Fault fault() const { return fault_; }                        // of the last disarming or refusal, until armed
  bool arming_refused() const { return arming_refused_; }       // in this step; with kCommanded for a fault: pressed
  const DeviceLimits& limits() const { return limits_; }        // those in force
  const double* last_force_n() const { return last_force_n_; }  // 3: let through in the last step

 private:
  Fault fault_of(const GateInput& input, double since_step_s) const;
  Fault fault_of_tip(const GateInput& input) const;
  bool may_arm(const GateInput& input) const;
  void disarm(Fault fault);
  void move_share(const GateInput& input, double step_s);
  GatedForce let_through(const double wanted_n[3], double step_s);

  DeviceLimits limits_;
  int axis_count_ = 0;
  double period_s_ = 0;
  bool knows_limits_ = false;
  Phase phase_ = Phase::kDisarmed;
  Fault fault_ = Fault::kCommanded;
  bool arming_refused_ = false;
  bool has_stepped_ = false, has_sample_ = false;
  std::uint64_t last_step_ns_ = 0, last_slept_ns_ = 0, last_sample_ns_ = 0;
  TipPose tip_;       // of the last sample
  double share_ = 0;  // of the wanted force: 0 to 1
  double last_force_n_[3] = {};
};

}  // namespace fdcg::dev
