// SPDX-License-Identifier: Apache-2.0
#include "tick/stability.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"

namespace fdcg::dev {
namespace {

constexpr double kGapPeriods = 2.5;  // between two reports: more was lost than one
constexpr double kWarm = 0.8;        // of the heat that is allowed: from here on the force limit comes down

double square(const double v[3]) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

}  // namespace

void Stability::begin(const StabilitySetup& setup, const DeviceLimits& limits, double rate_hz) {
  *this = Stability();
  setup_ = setup;
  period_s_ = rate_hz > 0 ? 1 / rate_hz : 0;
  limits_ = limits;
  bounces_.begin(period_s_);
}

void Stability::reset() {
  Stability fresh;
  fresh.setup_ = setup_;
  fresh.limits_ = limits_;
  fresh.period_s_ = period_s_;
  fresh.heat_n2_ = heat_n2_;
  fresh.bounces_.begin(period_s_);
  *this = fresh;
}

void Stability::step(const double tip_m[3], std::uint64_t now_ns, const double sent_n[3], double round_trip_s, bool rubs,
                     double force_n[3], const EffectForce& effects) {
  if (!is_finite(tip_m) || !is_finite(force_n)) return;  // the gate's to disarm for
  const double seconds = has_last_ && now_ns > last_ns_ ? static_cast<double>(now_ns - last_ns_) * 1e-9 : 0;
  for (int i = 0; i < 3; ++i)
    sent_n_[sent_count_ % kSent][i] = sent_n[i] - effects.sent_n[i];
  ++sent_count_;
  const bool is_gap = seconds > kGapPeriods * period_s_;
  if (is_gap) bounces_.begin(period_s_);  // in a gap what moved was not seen
  const bool is_thrown = bounces_.step(tip_m, now_ns, force_n, share_ < 1 ? kCalmedBounces : kBounces);
  double way_m[3] = {};
  for (int i = 0; has_last_ && i < 3; ++i)
    way_m[i] = tip_m[i] - last_m_[i];
  for (int i = 0; i < 3; ++i)
    force_n[i] *= share_;
  if (has_last_) observe(way_m, round_trip_s);
  const double in_springs_j = setup_.stiffness_n_per_m > 0 ? square(force_n) / (2 * setup_.stiffness_n_per_m * share_) : 0;
  stored_j_ = std::clamp(stored_j_, -kMostOwed_j, in_springs_j + kFreeEnergy_j);
  path_m_ += std::sqrt(square(way_m));
  if (rubs || is_gap) forget_swings();
  damping_n_s_per_m_ = 0;
  if (setup_.has_passivity && has_last_) damp(way_m, seconds, force_n);
  if (is_thrown && setup_.has_calming && setup_.has_passivity) calm(bounces_.since_ns(), now_ns);
  if (setup_.has_calming) look_for_shaking(force_n, tip_m, now_ns);
  for (int i = 0; i < 3; ++i)
    if (effects.now_n[i] != 0) force_n[i] += share_ * effects.now_n[i];
  if (limits_.continuous_force_n > 0) cool(sent_n, seconds, force_n);
  std::copy_n(tip_m, 3, last_m_);
  last_ns_ = now_ns;
  has_last_ = true;
}

void Stability::forget_swings() {
  for (Axis& axis : axes_)
    axis.count = 0;
}

// The way since the last report, with the force that was felt on it.
void Stability::observe(const double way_m[3], double round_trip_s) {
  const double periods = period_s_ > 0 ? round_trip_s / period_s_ : 0;
  const auto back = static_cast<std::uint32_t>(std::clamp(std::nearbyint(periods), 1.0, kSent - 1.0));
  if (back > sent_count_) return;
  const double given = dot(sent_n_[(sent_count_ - back) % kSent], way_m);
  if (!std::isfinite(given)) return;
  stored_j_ -= given;
  given_j_ += given;
  moved_j_ += std::fabs(given);
}

// Swings smaller than kSwingShare are none.
bool Stability::has_reversed(Axis& axis, double force_n, const double tip_m[3], std::uint64_t now_ns) const {
  const double least_n = kSwingShare * limits_.force_n;
  if (axis.direction == 0) {
    if (std::fabs(force_n - axis.turned_n) < least_n) return false;
    axis.direction = force_n > axis.turned_n ? 1 : -1;
    axis.extreme_n = force_n;
    return false;
  }
  if (axis.direction * (force_n - axis.extreme_n) > 0) axis.extreme_n = force_n;
  if (axis.direction * (axis.extreme_n - force_n) < least_n) return false;
  const Axis::Reversal& before = axis.last[(axis.count + kReversals - 1) % kReversals];
  const bool goes_on = axis.count > 0 && static_cast<double>(now_ns - before.ns) * 1e-9 < kShakePauseS;
  if (!goes_on) {
    axis.since_ns = now_ns;
    axis.count = 0;
  }
  Axis::Reversal& now = axis.last[axis.count++ % kReversals];
  now = {now_ns, std::fabs(axis.extreme_n - axis.turned_n), path_m_, {tip_m[0], tip_m[1], tip_m[2]}, given_j_, moved_j_};
  axis.direction = -axis.direction;
  axis.turned_n = axis.extreme_n;
  axis.extreme_n = force_n;
  return axis.count >= kReversals;
}

bool Stability::is_shaking(const Axis& axis) {
  const Axis::Reversal &first = axis.last[axis.count % kReversals], &last = axis.last[(axis.count - 1) % kReversals];
  const double way_m[3] = {last.place_m[0] - first.place_m[0], last.place_m[1] - first.place_m[1],
                           last.place_m[2] - first.place_m[2]};
  const double path_m = last.path_m - first.path_m;
  return static_cast<double>(last.ns - first.ns) * 1e-9 <= kShakeS && last.swing_n >= kFadingShare * first.swing_n &&
         last.given_j - first.given_j >= -kLossShare * (last.moved_j - first.moved_j) &&
         square(way_m) <= kInPlaceShare * kInPlaceShare * path_m * path_m;
}

// What is wanted, as far as it may be felt: the gate's own fading is no shaking.
void Stability::look_for_shaking(const double force_n[3], const double tip_m[3], std::uint64_t now_ns) {
  const double length = std::sqrt(square(force_n)), felt = length > limits_.force_n ? limits_.force_n / length : 1;
  for (int i = 0; i < 3; ++i)
    if (has_reversed(axes_[i], felt * force_n[i], tip_m, now_ns) && is_shaking(axes_[i]))
      return calm(axes_[i].since_ns, now_ns);
}

// The count of swings begins anew, the time of shaking only where the last calming had ended it.
void Stability::calm(std::uint64_t since_ns, std::uint64_t now_ns) {
  const bool is_new = calmings_ == 0 || static_cast<double>(now_ns - last_calmed_ns_) * 1e-9 > 2 * kShakeS;
  if (is_new) shakes_since_ns_ = since_ns;
  last_calmed_ns_ = now_ns;
  shakes_ = calmings_ == kMostCalmings || static_cast<double>(now_ns - shakes_since_ns_) * 1e-9 > kLongestShakeS;
  ++calmings_;
  share_ *= kCalmingShare;
  forget_swings();
}

// As much damping as takes what is owed within one period, at the speed of now.
void Stability::damp(const double way_m[3], double seconds, double force_n[3]) {
  const double way2 = square(way_m);
  if (stored_j_ >= 0 || !(way2 > 0) || !(seconds > 0)) return;
  const double wanted = -stored_j_ * seconds / way2;
  damping_n_s_per_m_ = std::min(wanted, kMostDamping_n_s_per_m);
  for (int i = 0; i < 3; ++i)
    force_n[i] -= damping_n_s_per_m_ * way_m[i] / seconds;
}

void Stability::cool(const double sent_n[3], double seconds, double force_n[3]) {
  const double continuous_n = limits_.continuous_force_n, allowed = continuous_n * continuous_n;
  heat_n2_ += (square(sent_n) - heat_n2_) * (1 - std::exp(-seconds / limits_.heat_s));
  const double room = std::clamp((allowed - heat_n2_) / (allowed * (1 - kWarm)), 0.0, 1.0);
  const double limit = continuous_n + (limits_.force_n - continuous_n) * room;
  const double length = std::sqrt(square(force_n));
  is_hot_ = limit < limits_.force_n && length > limit;
  for (int i = 0; is_hot_ && i < 3; ++i)
    force_n[i] *= limit / length;
}

}  // namespace fdcg::dev
