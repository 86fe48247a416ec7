// SPDX-License-Identifier: Apache-2.0
#include "replay.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>
#include <utility>

#include "result_law.hpp"
#include "ulp.hpp"

namespace fdcg::test {
namespace {

constexpr double kTieRoundings = 64;  // a decision within so many eps of the extent is a tie
// Where near-flat faces were merged, the corners are off their planes: two of them on both sides.
constexpr double kTieDeviations = 4;
constexpr double kSame_ulps = 8;  // god-objects this near are one: the tie was of names only
constexpr std::uint64_t kMostTiesLookedAt = 50;
constexpr int kMostCarried = 100;  // ticks that a sweep may be carried over

template <class Real>
double distance(const Vector<Real>& a, const double* b) {
  const Vector<Real> d{a.x - Real(b[0]), a.y - Real(b[1]), a.z - Real(b[2])};
  return static_cast<double>(length(d));
}

template <class Real>
bool agree(const ReferenceContact<Real>& a, const fdcg_contact& b) {
  return a.state == b.state && a.feature == b.feature && a.is_slipping == (b.slipping != 0);
}

std::string describe(const fdcg_contact& c) {
  static const char* const names[] = {"free", "face", "edge", "vertex"};
  std::ostringstream text;
  text << names[c.state] << ' ' << static_cast<std::int32_t>(c.feature) << (c.slipping ? " slips" : " sticks") << std::hexfloat
       << " GO " << c.god_object[0] << ' ' << c.god_object[1] << ' ' << c.god_object[2] << " last HIP " << c.hip[0] << ' '
       << c.hip[1] << ' ' << c.hip[2];
  return text.str();
}

}  // namespace

template <class Real>
Replay<Real>::Replay(const fdcg_graph& graph, const fdcg_params& params)
    : graph_(graph),
      params_(params),
      friction_{params.mu_static, params.mu_dynamic, params.edge_friction == FDCG_EDGE_WEDGE},
      surface_(graph),
      ulp_(ulp_of_extent(*graph.header)),
      rounding_(kTieRoundings * surface_.epsilon + kTieDeviations * graph.header->max_deviation / surface_.extent) {
  along_.emplace(surface_, friction_);
}

template <class Real>
void Replay<Real>::restart(const fdcg_params& params) {
  params_ = params;
  friction_ = {params.mu_static, params.mu_dynamic, params.edge_friction == FDCG_EDGE_WEDGE};
  along_.emplace(surface_, friction_);
  contact_ = {};
  errors = {};
}

template <class Real>
Hip Replay<Real>::god_object_m() const {
  Hip m{};
  for (std::size_t k = 0; k < 3; ++k)
    m[k] = (contact_.god_object[k] + graph_.header->origin[k]) * graph_.header->metres_per_unit;
  return m;
}

template <class Real>
ReferenceContact<Real> Replay<Real>::answer(const Tick& tick) const {
  ReferenceWalker<Real> walker(surface_, friction_);
  walker.resynchronise(tick.before);
  walker.step(tick.hip);
  return walker.contact;
}

template <class Real>
void Replay<Real>::step(const Hip& hip_object_m) {
  const Tick tick = {contact_, surface_.local(hip_object_m.data())};
  const bool was_carried = std::exchange(is_carried_, false);
  fdcg_result output;
  fdcg_step(&graph_, &params_, &contact_, hip_object_m.data(), &output);
  for (int i = 0; i < kMostCarried && (output.flags & FDCG_RESULT_SWEEP_BOUND) != 0; ++i)
    fdcg_step(&graph_, &params_, &contact_, hip_object_m.data(), &output);
  ++errors.steps;
  const ResultLaw law = result_law(*graph_.header, params_, contact_, hip_object_m, output);
  if ((!law.is_of_contact || !law.is_of_spring) && errors.wrong++ == 0) errors.first_wrong = "result or force: " + say(tick);
  if ((output.flags & (FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND)) != 0 || was_carried)
    return pass_over_carried(output.flags);
  last_ = judge(tick);
  errors.transitions += last_.step.transitions;
  errors.contact_steps += last_.is_contact;
  if (last_.verdict == TickError::Verdict::wrong && errors.wrong++ == 0) errors.first_wrong = say(tick);
  if (last_.verdict == TickError::Verdict::tie) {
    ++errors.ties;
    if (explains_ties && last_.ulps > kSame_ulps) explain_tie(tick);
  }
  if (last_.verdict == TickError::Verdict::agrees && last_.is_contact) {
    if (last_.ulps > kWorthACloserLook_ulps) look_closer(tick);
    errors.one_step.push_back(static_cast<float>(last_.ulps));
    if (last_.ulps > errors.worst_ulps) {
      errors.worst_ulps = last_.ulps;
      if (last_.ulps > kSame_ulps) errors.worst = say(tick);
    }
  }
  accumulate(tick.hip);
}

// What is a tie in fewer bits is judged again in 256: where the runtime agrees with those, it was none. They do not say how
// near a face was that they pass, so where it does not, the margin of fewer bits stands.
template <class Real>
TickError Replay<Real>::judge(const Tick& tick) {
  const TickError error = judge_in(surface_, tick);
  if (std::is_same_v<Real, Mpfr256> || error.verdict != TickError::Verdict::tie) return error;
  if (!widest_) widest_.emplace(graph_);
  const TickError again = judge_in(*widest_, tick);
  return again.verdict == TickError::Verdict::agrees ? again : error;
}

template <class Real>
template <class Any>
TickError Replay<Real>::judge_in(const ReferenceSurface<Any>& surface, const Tick& tick) const {
  TickError error;
  error.is_contact = contact_.state != FDCG_FREE;
  ReferenceWalker<Any> walker(surface, friction_);
  walker.resynchronise(tick.before);
  error.step = walker.step(tick.hip);
  error.ulps = distance(walker.contact.god_object, contact_.god_object) / ulp_;
  const bool is_same = agree(walker.contact, contact_);
  if (error.step.margin <= rounding_) {
    // Two ways may part at a tie and end on one feature.
    if (!is_same || error.ulps > kSame_ulps) error.verdict = TickError::Verdict::tie;
  } else if (!is_same) {
    error.verdict = TickError::Verdict::wrong;
  }
  return error;
}

// The references have no bound on a tick's work: where the step carries some over, they start anew from its contact.
template <class Real>
void Replay<Real>::pass_over_carried(std::uint32_t flags) {
  last_ = {};
  last_.is_contact = contact_.state != FDCG_FREE;
  is_carried_ = (flags & FDCG_RESULT_SWEEP_BOUND) != 0;
  errors.contact_steps += last_.is_contact;
  errors.carried += last_.is_contact;
  along_->resynchronise(contact_);
}

// Both start anew from the runtime's contact at a tie of either.
template <class Real>
void Replay<Real>::accumulate(const Hip& hip) {
  const ReferenceStep step = along_->step(hip);
  const double ulps = distance(along_->contact.god_object, contact_.god_object) / ulp_;
  const bool have_parted = step.margin <= rounding_ && ulps > kSame_ulps;
  if (last_.verdict != TickError::Verdict::agrees || !agree(along_->contact, contact_) || have_parted) {
    along_->resynchronise(contact_);
  } else if (last_.is_contact) {
    errors.accumulated.push_back(static_cast<float>(ulps));
  }
}

// Central differences of the right answer, one coordinate of one input at a time.
template <class Real>
void Replay<Real>::look_closer(const Tick& tick) {
  const ReferenceContact<Real> right = answer(tick);
  for (std::size_t k = 0; k < 6; ++k) {
    for (const double half : {-0.5, 0.5}) {
      Tick moved = tick;
      (k < 3 ? moved.hip[k] : moved.before.god_object[k - 3]) += half * ulp_;
      if (tick.before.state == FDCG_FREE) std::copy_n(moved.before.god_object, 3, moved.before.hip);
      const ReferenceContact<Real> other = answer(moved);
      if (other.state != right.state || other.feature != right.feature) continue;
      const double moved_by = static_cast<double>(length(other.god_object - right.god_object));
      last_.conditioning = std::max(last_.conditioning, moved_by / (ulp_ / 2));
    }
  }
  errors.worst_conditioning = std::max(errors.worst_conditioning, last_.conditioning);
  errors.looked_at.emplace_back(static_cast<float>(last_.ulps), static_cast<float>(last_.conditioning));
}

// Backward error of a tie: the smallest inputs' change, out of random ones, that makes the replay give the runtime's answer.
template <class Real>
void Replay<Real>::explain_tie(const Tick& tick) {
  if (errors.ties_explained + errors.ties_unexplained >= kMostTiesLookedAt) return;
  constexpr int kTriesOfASize = 12;
  for (double size = 1; size <= kTieRoundings; size *= 2) {
    for (int i = 0; i < kTriesOfASize; ++i) {
      Tick moved = tick;
      for (std::size_t k = 0; k < 3; ++k) {
        moved.hip[k] += random_.uniform(-size, size) * ulp_;
        moved.before.god_object[k] += random_.uniform(-size, size) * ulp_;
      }
      if (tick.before.state == FDCG_FREE) std::copy_n(moved.before.god_object, 3, moved.before.hip);
      const ReferenceContact<Real> other = answer(moved);
      if (distance(other.god_object, contact_.god_object) > (kTieRoundings + kTieRoundings) * ulp_) continue;
      ++errors.ties_explained;
      return;
    }
  }
  if (errors.ties_unexplained++ == 0) errors.first_unexplained = say(tick);
}

template <class Real>
std::string Replay<Real>::say(const Tick& tick) const {
  std::ostringstream text;
  text << "step " << errors.steps << ": HIP " << std::hexfloat << tick.hip[0] << ' ' << tick.hip[1] << ' ' << tick.hip[2]
       << std::defaultfloat << ", mu " << params_.mu_static << '/' << params_.mu_dynamic
       << "\n  before:  " << describe(tick.before) << "\n  runtime: " << describe(contact_)
       << "\n  replay:  " << test::describe(last_.step) << "\n  apart " << last_.ulps << " ulps, conditioning "
       << last_.conditioning;
  return text.str();
}

template class Replay<long double>;
template class Replay<Mpfr256>;

}  // namespace fdcg::test
