// SPDX-License-Identifier: Apache-2.0
// What a contender's answers along a way are worth, beside the truth.
#pragma once

#include <cstdint>
#include <vector>

#include "contender.hpp"
#include "truth.hpp"
#include "ways.hpp"

namespace fdcg::test {

// The least change of a force that a hand can tell, as a part of it (Pang, Tan and Durlach 1991).
constexpr double kNoticeableForce = 0.07;

struct Metrics {
  std::uint64_t ticks = 0, contact_ticks = 0;        // of the truth
  std::uint64_t transitions = 0, carried_ticks = 0;  // of the contender
  // After a tie there are answers that are as right as the truth (TrueBody::Tick::others). Ticks of true contact in which the
  // contender is not at the truth, kApart_m or more off, but at another, as a share; those in which it is where the model is
  // with HIP and corners rounded to floats, apart from them, for what computes so; and the error from the nearest right answer
  // over every tick. `equal_share`: of the tied, those that are as near to the HIP as the truth in all digits, without
  // friction: faces that lie alike, between which no precision decides.
  double tied_share = 0, equal_share = 0, in_floats_share = 0, judged_rms_m = 0;
  // Carried ticks in which the contender is neither at a right answer nor on the way to it (CarriedWay).
  std::uint64_t astray_ticks = 0;
  // Ticks of true contact, as a share, in which nothing tells whether it is one: a force that is lost in a carried tick whose
  // way is not known.
  double unjudged_share = 0;
  // |god-object - true god-object| over every tick; a free contender's god-object is the HIP, as the truth's is.
  double god_object_rms_m = 0, god_object_p50_m = 0, god_object_p99_m = 0, god_object_max_m = 0;
  double force_rms_n = 0, force_max_n = 0;              // |force - true force|
  double force_share_p99 = 0;                           // of the true force, over ticks of true contact
  double noticeable_share = 0;                          // of those: beyond kNoticeableForce
  double direction_p99_deg = 0, direction_max_deg = 0;  // over ticks that both are in contact
  double jump_n_per_ms = 0, true_jump_n_per_ms = 0;     // the largest change of force within a millisecond
  double wrong_feature_share = 0;  // of ticks of true contact: god-object over 5 micrometres from the true feature
  // Pushed through: the HIP is over 10 micrometres below the true god-object, and the contender is free or pushes over 135
  // degrees away from the true force, and from the force of every other right answer; in carried ticks, if it is not on its way
  // to one.
  std::uint64_t push_throughs = 0;  // times that it begins
  double push_through_share = 0;    // of ticks of true contact
  double phantom_share = 0;         // of truly free ticks: a force of over 10 micrometres' depth
};
// From the nearest right answer, in metres. is_double: of a contender that computes in double, which owes more.
double error_of(const Feel& felt, const TrueBody::Tick& truth, bool is_double = false);

Metrics judge(const Way& way, double rate_hz, const std::vector<Feel>& felt, const std::vector<TrueBody::Tick>& truth,
              const TrueBody& body, const ReferenceFriction& friction = {}, bool is_double = false);

// The contender's answers along a way, from its start.
std::vector<Feel> feel_along(Contender& contender, const Way& way);

// Along the way and back again: a closed loop that begins and ends in free space. The work done on the user, and the most that
// a passive spring behind a zero-order hold may do: stiffness * (sum |dx|^2 + sum of depth^2 at first contacts) / 2.
struct LoopEnergy {
  double work_j = 0, bound_j = 0;
};
LoopEnergy energy_of_loop(Contender& contender, const Way& way);

// The god-object's largest distance from where it was, over 500 ticks of a HIP held still, at some places of true contact along
// the way.
double creep_m(Contender& contender, const Way& way, const std::vector<TrueBody::Tick>& truth);

}  // namespace fdcg::test
