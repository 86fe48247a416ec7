// SPDX-License-Identifier: Apache-2.0
// How far the runtime's god-object is from the right one, tick by tick: the same rules replayed in a wider number type
// (ReferenceWalker), on one way of the HIP. Lengths are in ulps of the extent (ulp.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact_rig.hpp"
#include "fdcg/fdcg.h"
#include "hip_walk.hpp"
#include "random.hpp"
#include "reference_walker.hpp"

namespace fdcg::test {

// What one tick came to, from the runtime's own contact before it.
struct TickError {
  enum class Verdict {
    agrees,  // the same state, feature and slip flag
    tie,     // a decision of the replay was within rounding, and the two differ, in 256 bits too: both outcomes are right
    wrong    // they differ without that excuse
  };
  Verdict verdict = Verdict::agrees;
  bool is_contact = false;
  double ulps = 0;          // between the runtime's god-object and the replay's
  double conditioning = 1;  // of ticks beyond kWorthACloserLook: see worst_conditioning
  ReferenceStep step;
};

constexpr double kWorthACloserLook_ulps = 4;

// All ticks of one way.
struct ReplayErrors {
  std::uint64_t steps = 0, contact_steps = 0, transitions = 0, ties = 0, wrong = 0;
  std::uint64_t carried = 0;  // contact ticks that carry work over
  // Of the ties where the two god-objects are apart: those for which inputs a few ulps off were found with which the replay
  // gives the runtime's answer, and those for which none were (of at most kMostTiesLookedAt).
  std::uint64_t ties_explained = 0, ties_unexplained = 0;
  std::vector<float> one_step;     // ulps; contact ticks that are no ties
  std::vector<float> accumulated;  // ulps, along the way from a common contact at the last tie
  // How much further the right answer moves than the HIP or the god-object before is moved by half an ulp: the largest of the
  // ticks beyond kWorthACloserLook_ulps. Their one_step error and conditioning, in the order of the ticks:
  double worst_conditioning = 1;
  std::vector<std::pair<float, float>> looked_at;
  double worst_ulps = 0;
  std::string worst, first_wrong, first_unexplained;  // everything needed to repeat that tick
};

// Replays the rules in `Real` beside the runtime. Real: long double or Mpfr256.
template <class Real>
class Replay {
 public:
  Replay(const fdcg_graph& graph, const fdcg_params& params);

  void step(const Hip& hip_object_m);
  [[nodiscard]] const fdcg_contact& contact() const { return contact_; }
  [[nodiscard]] Hip god_object_m() const;
  [[nodiscard]] const TickError& last() const { return last_; }
  // A contact not yet started, under these parameters; the errors so far are forgotten.
  void restart(const fdcg_params& params);

  ReplayErrors errors;
  bool explains_ties = true;  // false: ties are counted, not looked into, which takes a hundred steps

 private:
  struct Tick {
    fdcg_contact before;
    Hip hip;  // local
  };
  [[nodiscard]] ReferenceContact<Real> answer(const Tick& tick) const;
  [[nodiscard]] TickError judge(const Tick& tick);
  template <class Any>
  [[nodiscard]] TickError judge_in(const ReferenceSurface<Any>& surface, const Tick& tick) const;
  void pass_over_carried(std::uint32_t flags);
  void accumulate(const Hip& hip);
  void look_closer(const Tick& tick);
  void explain_tie(const Tick& tick);
  [[nodiscard]] std::string say(const Tick& tick) const;

  const fdcg_graph& graph_;
  fdcg_params params_;
  ReferenceFriction friction_;
  ReferenceSurface<Real> surface_;
  std::optional<ReferenceSurface<Mpfr256>> widest_;  // where a tie has been judged again
  std::optional<ReferenceWalker<Real>> along_;
  Random random_{1};
  fdcg_contact contact_{};
  TickError last_;
  bool is_carried_ = false;  // the last tick left a sweep to do
  double ulp_;
  double rounding_;  // part of the extent: a decision within it is a tie
};

}  // namespace fdcg::test
