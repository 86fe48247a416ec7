// SPDX-License-Identifier: Apache-2.0
#include "tick/gate.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"

namespace fdcg::dev {
namespace {

// Keeps a rounded product from exceeding a limit by its last bit.
constexpr double kJustBelow = 1 - 0x1p-50;

// Larger limits have no effect, and their squares may overflow.
constexpr double kAbsurd = 1e9;

bool is_known(double limit) {
  return limit > 0 && limit <= kAbsurd;
}

// Also for numbers whose squares are none.
double norm(const double v[3]) {
  return std::hypot(v[0], v[1], v[2]);
}

// v, made no longer than `limit`.
void shorten(double v[3], double limit) {
  const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (largest > limit) {
    for (int i = 0; i < 3; ++i)
      v[i] = v[i] / largest * limit;
  }
  const double length = norm(v);
  if (length <= limit) return;
  for (int i = 0; i < 3; ++i)
    v[i] *= limit / length * kJustBelow;
}

// Slew limit from `last` towards `force`: the nearest point within `most` of t * last, for the best t in 0 to 1. So the change
// is at most `most`, apart from a scaling towards zero.
void limit_slew(const double last[3], double most, double force[3]) {
  const double square = dot(last, last);
  const double t = square > 0 ? std::clamp(dot(force, last) / square, 0.0, 1.0) : 1;
  double change[3];
  for (int i = 0; i < 3; ++i)
    change[i] = force[i] - t * last[i];
  if (norm(change) <= t * most) return;
  shorten(change, t * most);
  for (int i = 0; i < 3; ++i)
    force[i] = t * last[i] + change[i];
}

struct FaultWords {
  const char *name, *text;
};
constexpr FaultWords kWords[kFaults] = {
    {"none", "no fault"},
    {"unknown-limit", "the profile leaves a limit unknown, so there is no force; fill in its \"limits\""},
    {"silence", "no good report for 10 ms; look at the cable and the device, then arm again"},
    {"writer-stuck",
     "a force was not taken for 5 ms: the device holds writes up, or this computer did not run the thread that writes; look at "
     "the device, give this program real-time priority, then arm again"},
    {"write-failed", "a force could not be written; the device is gone or refuses its output report"},
    {"read-failed", "the device is gone; plug it in again, then arm"},
    {"not-finite", "a force or position was not a finite number; please report this with the log"},
    {"workspace", "the tip is outside the profile's workspace_m; calibrate the device or correct the profile, then arm again"},
    {"speed", "the tip moved faster than the profile's velocity_m_per_s; arm again"},
    {"host-late", "this computer did not run the loop for 10 ms; give it real-time priority, then arm again"},
    {"device-fault", "the device reports a fault of its own; clear it there, then arm again"},
    {"not-armed", "not armed, or disarmed by command; arm when the hand is free"},
    {"clock", "this computer's clock went backwards; arm again"},
    {"slept", "this computer was suspended; look at the device, then arm again"},
    {"not-taken", "the device took no force for 10 ms, or does not apply what it takes; look at the device, then arm again"},
    {"other-host", "the device answers what another program sends; end that program, then arm again"},
    {"restarted", "the device began anew; look at it, then arm again"},
    {"reports-lost", "too many of the device's reports are lost; look at the cable and the hub, then arm again"},
    {"lag", "what is sent to the device comes back too late for stable contact; look for a slow hub or driver, then arm again"},
    {"shaking",
     "the loop of hand, device and scene shakes; lower the scene's stiffness or raise the device's rate, then arm again"},
    {"released", "the dead-man button is not held; hold it, then arm again"},
};

}  // namespace

const char* fault_name(Fault fault) {
  return kWords[static_cast<int>(fault)].name;
}
const char* fault_text(Fault fault) {
  return kWords[static_cast<int>(fault)].text;
}

bool are_known(const DeviceLimits& limits, int axis_count, double rate_hz) {
  bool known =
      is_known(rate_hz) && is_known(limits.force_n) && is_known(limits.slew_n_per_s) && is_known(limits.velocity_m_per_s);
  for (int i = 0; i < 3; ++i) {
    known = known && std::isfinite(limits.workspace_min_m[i]) && std::isfinite(limits.workspace_max_m[i]) &&
            limits.workspace_min_m[i] < limits.workspace_max_m[i];
  }
  for (int axis = 0; axis < axis_count; ++axis)
    known = known && is_known(limits.effort[axis]);
  return known && axis_count >= 1 && axis_count <= kMaxAxes;
}

void Gate::begin(const DeviceLimits& limits, int axis_count, double rate_hz, double most_force_n) {
  *this = Gate();
  limits_ = limits;
  axis_count_ = axis_count;
  knows_limits_ = are_known(limits, axis_count, rate_hz);
  if (!knows_limits_) {
    fault_ = Fault::kUnknownLimit;
    return;
  }
  period_s_ = 1 / rate_hz;
  if (most_force_n > 0) limits_.force_n = std::min(limits_.force_n, most_force_n);
  const bool has_watchdog = is_known(limits.device_watchdog_s) && limits.device_watchdog_s <= kLongestWatchdogS;
  if (!has_watchdog) limits_.force_n = std::min(limits_.force_n, kForceWithoutWatchdogN);
}

GatedForce Gate::step(const GateInput& input) {
  const bool goes_back = has_stepped_ && input.now_ns < last_step_ns_;
  const double since_step_s = has_stepped_ && !goes_back ? static_cast<double>(input.now_ns - last_step_ns_) * 1e-9 : 0;
  const bool has_slept =
      has_stepped_ && static_cast<double>(input.slept_ns) - static_cast<double>(last_slept_ns_) >= kSilenceS * 1e9;
  const Fault fault = has_slept ? Fault::kSlept : goes_back ? Fault::kClock : fault_of(input, since_step_s);
  has_stepped_ = true;
  last_step_ns_ = input.now_ns;
  last_slept_ns_ = input.slept_ns;
  const bool takes_sample = input.has_sample && input.is_tip_valid && is_finite(input.tip.position_m);
  if (takes_sample) {
    has_sample_ = true;
    last_sample_ns_ = input.now_ns;
    tip_ = input.tip;
  }
  arming_refused_ = false;
  if (phase_ != Phase::kDisarmed && fault != Fault::kNone) disarm(fault);
  if (phase_ == Phase::kDisarmed && input.arm) {
    arming_refused_ = fault != Fault::kNone || input.lags || !may_arm(input);
    if (arming_refused_ && knows_limits_) fault_ = fault != Fault::kNone ? fault : input.lags ? Fault::kLag : Fault::kCommanded;
    if (arming_refused_) return GatedForce();
    phase_ = Phase::kRamping;
    fault_ = Fault::kNone;
  }
  if (phase_ == Phase::kDisarmed) return GatedForce();
  const double step_s = std::min(since_step_s, 2 * period_s_);
  move_share(input, since_step_s);
  return let_through(input.wanted_force_n, step_s);
}

// The fault, if any, that must remove the force now.
Fault Gate::fault_of(const GateInput& input, double since_step_s) const {
  if (input.read_failed) return Fault::kReadFailed;
  if (input.write_failed) return Fault::kWriteFailed;
  if (static_cast<double>(input.write_busy_ns) * 1e-9 >= kWriterStuckS) return Fault::kWriterStuck;
  if (since_step_s >= kSilenceS) return Fault::kHostLate;
  if (input.device_fault) return Fault::kDeviceFault;
  if (input.link_fault != Fault::kNone) return input.link_fault;
  if (input.has_sample) {
    const Fault fault = fault_of_tip(input);
    if (fault != Fault::kNone) return fault;
  } else if (static_cast<double>(input.now_ns - last_sample_ns_) * 1e-9 >= kSilenceS) {
    return Fault::kSilence;
  }
  if (!is_finite(input.wanted_force_n)) return Fault::kNotFinite;
  return input.disarm ? Fault::kCommanded : Fault::kNone;
}

Fault Gate::fault_of_tip(const GateInput& input) const {
  const double* const tip = input.tip.position_m;
  if (!input.is_tip_valid) return Fault::kWorkspace;
  if (!is_finite(tip)) return Fault::kNotFinite;
  for (int i = 0; i < 3; ++i) {
    if (tip[i] < limits_.workspace_min_m[i] || tip[i] > limits_.workspace_max_m[i]) return Fault::kWorkspace;
  }
  if (!has_sample_) return Fault::kNone;
  // One period more than the host's clock has: two reports read at once were made a period apart.
  const double time_s = static_cast<double>(input.now_ns - last_sample_ns_) * 1e-9 + period_s_;
  const double way[3] = {tip[0] - tip_.position_m[0], tip[1] - tip_.position_m[1], tip[2] - tip_.position_m[2]};
  return norm(way) > limits_.velocity_m_per_s * time_s ? Fault::kSpeed : Fault::kNone;
}

bool Gate::may_arm(const GateInput& input) const {
  return knows_limits_ && has_sample_ && norm(input.wanted_force_n) <= kArmForceShare * limits_.force_n;
}

void Gate::disarm(Fault fault) {
  phase_ = Phase::kDisarmed;
  fault_ = fault;
  share_ = 0;
  for (double& force : last_force_n_)
    force = 0;
}

void Gate::move_share(const GateInput& input, double step_s) {
  const double silent_s = static_cast<double>(input.now_ns - last_sample_ns_) * 1e-9;
  if (silent_s >= kMissedTicksToFade * period_s_) {
    phase_ = Phase::kFading;
    share_ = std::max(0.0, share_ - step_s / kFadeS);
    return;
  }
  share_ = std::min(1.0, share_ + std::min(step_s, 2 * period_s_) / kRampS);
  phase_ = share_ < 1 ? Phase::kRamping : Phase::kArmed;
}

GatedForce Gate::let_through(const double wanted_n[3], double step_s) {
  double force[3] = {wanted_n[0], wanted_n[1], wanted_n[2]};
  shorten(force, limits_.force_n);
  for (double& component : force)
    component *= share_;
  limit_slew(last_force_n_, limits_.slew_n_per_s * step_s, force);
  shorten(force, limits_.force_n);

  double effort[kMaxAxes] = {};
  double ratio = 1;
  for (int axis = 0; axis < axis_count_; ++axis) {
    for (int i = 0; i < 3; ++i)
      effort[axis] += tip_.jacobian[i][axis] * force[i];
    if (!std::isfinite(effort[axis])) {
      disarm(Fault::kNotFinite);
      return GatedForce();
    }
    if (std::fabs(effort[axis]) > limits_.effort[axis]) {
      ratio = std::min(ratio, limits_.effort[axis] / std::fabs(effort[axis]) * kJustBelow);
    }
  }
  GatedForce gated;
  gated.is_enabled_ = true;
  for (int axis = 0; axis < axis_count_; ++axis) {
    gated.effort_[axis] = std::clamp(effort[axis] * ratio, -limits_.effort[axis], limits_.effort[axis]);
  }
  for (int i = 0; i < 3; ++i)
    last_force_n_[i] = gated.force_n_[i] = force[i] * ratio;
  return gated;
}

}  // namespace fdcg::dev
