// SPDX-License-Identifier: Apache-2.0
#include "lockstep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <sstream>

#include "fp_trap.hpp"
#include "step/contact_internals.hpp"

namespace fdcg::test {
namespace {

using Wide = long double;
constexpr double kGrowthShown = 16;
constexpr double kRoundings = 64;  // a decision within so many eps of the extent is a tie

Vector<Wide> wide(const double* v) {
  return {v[0], v[1], v[2]};
}

template <class Real>
double difference(const Vector<Real>& a, const double* b) {
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
  text << names[c.state] << ' ' << static_cast<std::int32_t>(c.feature) << " seat " << names[internals_of(c).seat_state] << ' '
       << static_cast<std::int32_t>(internals_of(c).seat_feature) << (c.slipping ? " slips" : " sticks") << std::hexfloat
       << " GO " << c.god_object[0] << ' ' << c.god_object[1] << ' ' << c.god_object[2] << " last HIP " << c.hip[0] << ' '
       << c.hip[1] << ' ' << c.hip[2];
  return text.str();
}

class Pair {
 public:
  Pair(const fdcg_graph& graph, const fdcg_params& params)
      : graph_(graph),
        params_(params),
        friction_{params.mu_static, params.mu_dynamic, params.edge_friction == FDCG_EDGE_WEDGE},
        surface_(graph),
        walker_(surface_, friction_),
        deviation_(4 * graph.header->max_deviation / graph.header->extent),
        tolerance_((surface_.is_f32 ? 1e-5 : 1e-12) + deviation_) {}

  void step(const Hip& hip_object);
  const fdcg_contact& contact() const { return contact_; }
  Lockstep result;

 private:
  void measure(const fdcg_contact& before, const Hip& hip, const fdcg_result& output);
  void judge(const fdcg_contact& before, const Hip& hip, double apart_before);
  void count_tie(const fdcg_contact& before, bool is_slip_only);
  double conditioning(const fdcg_contact& before, const Hip& hip, const ReferenceContact<HighPrecision>& right) const;

  const fdcg_graph& graph_;
  fdcg_params params_;
  ReferenceFriction friction_;
  ReferenceSurface<Wide> surface_;
  ReferenceWalker<Wide> walker_;
  std::unique_ptr<ReferenceSurface<HighPrecision>> exact_surface_;  // made when first needed
  fdcg_contact contact_{};
  double deviation_;  // exactness holds up to what the merging of near-flat faces moved; part of the extent
  double tolerance_;
  std::uint64_t last_tie_ = 0;  // the step of the last tie
};

// Ticks that a sweep over one of the test meshes may be carried over.
constexpr int kMostCarried = 100;

void Pair::step(const Hip& hip_object) {
  const fdcg_contact before = contact_;
  const double apart_before = difference(walker_.contact.god_object, before.god_object) / surface_.extent;
  fdcg_result output;
  {
    const FpTrap trap(hip_object.data());
    fdcg_step(&graph_, &params_, &contact_, hip_object.data(), &output);
    for (int i = 0; i < kMostCarried && (output.flags & FDCG_RESULT_SWEEP_BOUND) != 0; ++i) {  // the reference has no bound
      const std::uint32_t transitions = output.transitions;
      fdcg_step(&graph_, &params_, &contact_, hip_object.data(), &output);
      output.transitions += transitions;
    }
  }
  const Hip hip = surface_.local(hip_object.data());
  const ReferenceStep taken = walker_.step(hip);
  ++result.steps;
  result.transitions += output.transitions;
  result.contact_steps += contact_.state != FDCG_FREE;
  result.bound_hits += (output.flags & (FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND)) != 0;
  result.most_transitions = std::max<std::uint64_t>(result.most_transitions, taken.transitions);
  measure(before, hip, output);
  const double apart = difference(walker_.contact.god_object, contact_.god_object) / surface_.extent;
  if (agree(walker_.contact, contact_) && apart <= tolerance_) {
    result.worst_god_object = std::max(result.worst_god_object, apart);
  } else {
    judge(before, hip, before.started ? apart_before : 0);
    walker_.resynchronise(contact_);
  }
}

void Pair::measure(const fdcg_contact& before, const Hip& hip, const fdcg_result& output) {
  if (!before.started) return;
  const double* start = before.state == FDCG_FREE ? before.hip : before.god_object;
  const Wide old_distance = length(wide(start) - wide(hip.data()));
  const Wide new_distance = length(wide(contact_.god_object) - wide(hip.data()));
  const double growth = (static_cast<double>(new_distance - old_distance) / surface_.extent - deviation_) / surface_.epsilon;
  if (growth > kGrowthShown && result.first_growth.empty()) {
    std::ostringstream text;
    text << "step " << result.steps << ": grew by " << growth << " eps\n  before: " << describe(before)
         << "\n  after:  " << describe(contact_) << "\n  flags " << output.flags << ", transitions " << output.transitions;
    result.first_growth = text.str();
  }
  result.worst_growth = std::max(result.worst_growth, growth);
}

// By how much this step magnifies a rounding: what those of long double came to. A way around a corner of 500 faces that begins
// 1e-12 beside it turns by 1e-4 for a rounding of 1e-16.
double Pair::conditioning(const fdcg_contact& before, const Hip& hip, const ReferenceContact<HighPrecision>& right) const {
  ReferenceWalker<Wide> walker(surface_, friction_);
  walker.resynchronise(before);
  walker.step(hip);
  const Vector<Wide>& a = walker.contact.god_object;
  const Vector<HighPrecision>& b = right.god_object;
  const Vector<HighPrecision> d{HighPrecision(a.x) - b.x, HighPrecision(a.y) - b.y, HighPrecision(a.z) - b.z};
  return static_cast<double>(length(d)) / surface_.extent / static_cast<double>(std::numeric_limits<Wide>::epsilon());
}

// A HIP held still, and a contact that rests, are in the tie of the step before.
void Pair::count_tie(const fdcg_contact& before, bool is_slip_only) {
  const bool is_held = std::equal(before.hip, before.hip + 3, contact_.hip) &&
                       std::equal(before.god_object, before.god_object + 3, contact_.god_object) &&
                       before.state == contact_.state && before.feature == contact_.feature;
  const bool is_same = is_held && last_tie_ + 1 == result.steps;
  last_tie_ = result.steps;
  if (!is_same) ++(is_slip_only ? result.slip_ties : result.ties);
}

void Pair::judge(const fdcg_contact& before, const Hip& hip, double apart_before) {
  // The same step with all digits, from the runtime's own contact.
  if (!exact_surface_) exact_surface_ = std::make_unique<ReferenceSurface<HighPrecision>>(graph_);
  ReferenceWalker<HighPrecision> exact(*exact_surface_, friction_);
  exact.resynchronise(before);
  const ReferenceStep retaken = exact.step(hip);
  const ReferenceContact<HighPrecision>& right = exact.contact;
  const double apart = difference(right.god_object, contact_.god_object) / surface_.extent;
  const double rounding = kRoundings * surface_.epsilon + deviation_;
  if (agree(right, contact_) && apart <= tolerance_) {
    ++result.drifts;
    return;
  }
  const bool is_magnified =
      agree(right, contact_) && apart <= rounding * std::max<double>(retaken.amplification, conditioning(before, hip, right));
  if (retaken.margin <= rounding || is_magnified) {
    const bool is_slip_only = right.state == contact_.state && right.feature == contact_.feature && apart <= tolerance_;
    count_tie(before, is_slip_only);
    return;
  }
  if (result.failures++ > 0) return;
  std::ostringstream text;
  text << "step " << result.steps << ": HIP " << std::hexfloat << hip[0] << ' ' << hip[1] << ' ' << hip[2] << std::defaultfloat
       << "\n  before:    " << describe(before) << "\n  runtime:   " << describe(contact_)
       << "\n  reference: " << test::describe(retaken) << (exact.contact.is_slipping ? ", slips" : ", sticks")
       << "\n  god-objects apart " << apart << ", before " << apart_before << " of the extent";
  result.first_failure = text.str();
}

}  // namespace

Lockstep run_lockstep(const fdcg_graph& graph, const bake::PolygonSoup& soup, const fdcg_params& params, std::uint64_t steps,
                      std::uint64_t seed) {
  Pair pair(graph, params);
  HipWalk walk(soup, seed);
  bool was_on_feature = true;
  for (std::uint64_t i = 0; i < steps; ++i) {
    const fdcg_contact& c = pair.contact();
    const fdcg_header& h = *graph.header;
    Hip god_object{};
    for (std::size_t k = 0; k < 3; ++k)
      god_object[k] = (c.god_object[k] + h.origin[k]) * h.metres_per_unit;
    const Hip hip = walk.next(god_object);
    const bool is_off_features = !walk.is_on_feature() && !was_on_feature;
    was_on_feature = walk.is_on_feature();
    const std::uint64_t ties_before = pair.result.ties;
    pair.step(hip);
    pair.result.steps_off_features += is_off_features;
    pair.result.ties_off_features += is_off_features ? pair.result.ties - ties_before : 0;
  }
  return pair.result;
}

std::uint64_t step_count(std::uint64_t by_default) {
  const char* text = std::getenv("FDCG_STEPS");
  return text ? std::strtoull(text, nullptr, 10) : by_default;
}

}  // namespace fdcg::test
