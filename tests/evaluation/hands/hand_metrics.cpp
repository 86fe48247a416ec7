// SPDX-License-Identifier: Apache-2.0
#include "hand_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "band.hpp"
#include "metrics.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

double vibration_n(const std::vector<Point>& forces_n, double rate_hz) {
  constexpr double kLow_hz = 80, kHigh_hz = 450;  // where skin feels best
  double power = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> signal;
    signal.reserve(forces_n.size());
    for (const Point& force : forces_n)
      signal.push_back(force[k]);
    power += band_power(signal, rate_hz, kLow_hz, kHigh_hz);
  }
  return std::sqrt(power);
}

double angle_deg(const Point& a, const Point& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

double swing_m(const std::vector<HandTick>& ticks, std::size_t from, std::size_t to) {
  double swing = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    double low = ticks[from].device_m[k], high = low;
    for (std::size_t i = from; i < to; ++i)
      low = std::min(low, ticks[i].device_m[k]), high = std::max(high, ticks[i].device_m[k]);
    swing = std::max(swing, high - low);
  }
  return swing;
}

double work_j(const std::vector<HandTick>& ticks) {
  double work = 0;
  for (std::size_t i = 0; i + 1 < ticks.size(); ++i)
    work += dot(ticks[i].contact_n, ticks[i + 1].device_m - ticks[i].device_m);
  return work;
}

}  // namespace

HandMetrics judge_hand(const std::vector<HandTick>& ticks, const std::vector<HandTick>& truth, double rate_hz,
                       std::size_t held_from, std::size_t held_to) {
  HandMetrics m;
  std::vector<Point> off_n, true_n;
  std::vector<double> turned_deg;
  double square = 0;
  std::size_t contacts = 0, lost = 0, felt = 0, run = 0, longest = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const Point &mine = ticks[i].hand_n, &right = truth[i].hand_n, off = mine - right;
    off_n.push_back(off), true_n.push_back(right);
    square += dot(off, off);
    m.max_n = std::max(m.max_n, length(off));
    m.apart_m = std::max(m.apart_m, length(ticks[i].device_m - truth[i].device_m));
    if (length(mine) > kLeastFelt_n && length(right) > kLeastFelt_n) turned_deg.push_back(angle_deg(mine, right));
    contacts += truth[i].in_contact;
    lost += truth[i].in_contact && !ticks[i].in_contact;
    const bool is_felt = length(off) > std::max(kNoticeableForce * length(right), kLeastFelt_n);
    felt += is_felt;
    run = is_felt ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  const auto n = static_cast<double>(ticks.size());
  m.rms_n = std::sqrt(square / n);
  m.vibration_n = vibration_n(off_n, rate_hz);
  m.true_vibration_n = vibration_n(true_n, rate_hz);
  if (!turned_deg.empty()) {
    std::sort(turned_deg.begin(), turned_deg.end());
    m.direction_p99_deg = turned_deg[static_cast<std::size_t>(0.99 * static_cast<double>(turned_deg.size() - 1))];
  }
  m.felt_share = static_cast<double>(felt) / n;
  m.felt_ms = static_cast<double>(longest) / rate_hz * 1000;
  m.lost_share = contacts > 0 ? static_cast<double>(lost) / static_cast<double>(contacts) : 0;
  m.held_swing_m = swing_m(ticks, (held_from + held_to) / 2, held_to);
  m.gained_j = work_j(ticks);
  m.true_gained_j = work_j(truth);
  return m;
}

}  // namespace fdcg::test
