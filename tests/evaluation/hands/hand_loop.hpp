// SPDX-License-Identifier: Apache-2.0
// A haptic device of three axes, held by a hand that follows a target, in a loop with a contender that renders the body: what
// the hand feels of it. Between ticks each axis is integrated exactly (held_plant.hpp).
#pragma once

#include <vector>

#include "contender.hpp"
#include "held_plant.hpp"

namespace fdcg::test {

using Point = Ground::Point;

// The device (mass, damping) and the hand's spring and damper, alike along every axis.
struct HandSetup {
  double mass_kg = 0.1, damping_n_s_per_m = 1;
  double hand_n_per_m = 400, hand_n_s_per_m = 4;
  double rate_hz = 1000;

  [[nodiscard]] Plant axis() const { return {mass_kg, damping_n_s_per_m + hand_n_s_per_m, hand_n_per_m, 0}; }
};

struct HandTick {
  Point device_m{};   // where the contender was asked
  Point contact_n{};  // what it answered
  Point hand_n{};     // the force of spring and damper on the hand: what is felt
  bool in_contact = false;
};

// One tick a target. The device starts on the first, at rest; the contender is reset.
std::vector<HandTick> run_hand(Contender& contender, const std::vector<Point>& targets_m, const HandSetup& setup);

// Where a device is held against a body: it comes on the straight way from `outside` to `held`, and is pressed there by what
// the contender pushes back with.
struct Hold {
  Point outside_m{}, held_m{};
};

// The largest stiffness, as a part of `exact_n_per_m`, at which a device that is let go some micrometres beside its place comes
// to rest; 0 where it loses contact or shakes at the softest, a hundredth, and `kStiffest` where it never does.
constexpr double kStiffest = 4;
double stable_share(Contender& contender, const Hold& hold, const HandSetup& setup, double exact_n_per_m);

}  // namespace fdcg::test
