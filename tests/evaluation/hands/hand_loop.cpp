// SPDX-License-Identifier: Apache-2.0
#include "hand_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

using Axes = std::array<PlantState, 3>;

Point place_of(const Axes& axes) {
  return {axes[0].x_m, axes[1].x_m, axes[2].x_m};
}
Point velocity_of(const Axes& axes) {
  return {axes[0].v_m_per_s, axes[1].v_m_per_s, axes[2].v_m_per_s};
}
void advance(const HeldPlant& axis, const Point& force_n, Axes* axes) {
  for (std::size_t k = 0; k < 3; ++k)
    (*axes)[k] = axis.after_tick((*axes)[k], force_n[k]);
}

constexpr int kApproachTicks = 60, kSettleTicks = 60;
constexpr double kLetGo_m = 2e-5;
constexpr double kSoftest = 0.01;
constexpr Point kBeside = {0.36, 0.48, 0.8};  // of unit length, along no feature of a turned body

bool comes_to_rest(Contender& contender, const Hold& hold, const HandSetup& setup, double stiffness_n_per_m) {
  constexpr long kTicks = 6000;
  constexpr double kGrowth = 1 + 1e-5;
  constexpr double kGone_m = 5e-8;  // a dozen roundings of a float on a body of 0.1 m: less tells nothing
  contender.reset();
  Feel feel;
  for (int i = 0; i <= kApproachTicks + kSettleTicks; ++i) {
    const double part = std::min(1.0, static_cast<double>(i) / kApproachTicks);
    contender.step(hold.outside_m + (hold.held_m - hold.outside_m) * part, feel);
  }
  if (!feel.in_contact) return false;
  const double scale = stiffness_n_per_m / kStiffness_n_per_m;
  const Point push_n = feel.force * -scale;
  const HeldPlant axis(setup.axis(), 1 / setup.rate_hz);
  const double swing_per_s = std::sqrt((stiffness_n_per_m + setup.hand_n_per_m) / setup.mass_kg);
  Axes axes{};  // from hold.held_m
  for (std::size_t k = 0; k < 3; ++k)
    axes[k].x_m = kLetGo_m * kBeside[k];
  double early_m = 0, late_m = 0;
  for (long tick = 0; tick < kTicks; ++tick) {
    contender.step(hold.held_m + place_of(axes), feel);
    if (!feel.in_contact) return false;
    advance(axis, push_n + feel.force * scale, &axes);
    const double size_m = std::hypot(length(place_of(axes)), length(velocity_of(axes)) / swing_per_s);
    const long quarter = 4 * tick / kTicks;
    if (quarter == 1) early_m = std::max(early_m, size_m);
    if (quarter == 3) late_m = std::max(late_m, size_m);
  }
  return late_m < kGrowth * early_m || late_m < kGone_m;
}

}  // namespace

std::vector<HandTick> run_hand(Contender& contender, const std::vector<Point>& targets_m, const HandSetup& setup) {
  const HeldPlant axis(setup.axis(), 1 / setup.rate_hz);
  contender.reset();
  Axes axes{};
  for (std::size_t k = 0; k < 3; ++k)
    axes[k].x_m = targets_m[0][k];
  std::vector<HandTick> ticks(targets_m.size());
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const Point target_m_per_s = (targets_m[i] - targets_m[i > 0 ? i - 1 : 0]) * setup.rate_hz;
    HandTick& tick = ticks[i];
    tick.device_m = place_of(axes);
    Feel feel;
    contender.step(tick.device_m, feel);
    tick.in_contact = feel.in_contact;
    tick.contact_n = feel.force;
    tick.hand_n =
        (tick.device_m - targets_m[i]) * setup.hand_n_per_m + (velocity_of(axes) - target_m_per_s) * setup.hand_n_s_per_m;
    advance(axis, feel.force + targets_m[i] * setup.hand_n_per_m + target_m_per_s * setup.hand_n_s_per_m, &axes);
  }
  return ticks;
}

// From soft upwards, so that an island of instability is not jumped over, but for one narrower than a step; then by halves.
double stable_share(Contender& contender, const Hold& hold, const HandSetup& setup, double exact_n_per_m) {
  constexpr double kFactor = 1.3, kPrecision = 1e-3;
  const auto is_stable = [&](double share) { return comes_to_rest(contender, hold, setup, share * exact_n_per_m); };
  double stable = 0, unstable = kSoftest;
  while (is_stable(unstable)) {
    stable = unstable;
    if (unstable >= kStiffest) return kStiffest;
    unstable = std::min(unstable * kFactor, kStiffest);
  }
  while (stable > 0 && unstable / stable > 1 + kPrecision) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

}  // namespace fdcg::test
