// SPDX-License-Identifier: Apache-2.0
#include "metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "carried_way.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

constexpr double kBackwards = -0.7;  // a cosine: two forces of a right-angled corner are not opposite
constexpr double kTouch_m = 1e-5;    // depth from which a contact that is lost or made up counts
constexpr double kWrongFeature_m = kApart_m;
constexpr double kEqual_m = 1e-15;  // of two distances on bodies of 0.1 m: the rounding of doubles

double at(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values)
    sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double angle_deg(const Point& a, const Point& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

// Nothing is felt of a surface that the truth is in contact with, or a force away from it.
bool is_lost(const Feel& felt, const Feel& truth) {
  const double true_force = length(truth.force);
  return true_force > kTouch_m * kStiffness_n_per_m &&
         (!felt.in_contact || dot(felt.force, truth.force) < kBackwards * length(felt.force) * true_force);
}

bool is_at(const Feel& felt, const Feel& answer) {
  return felt.in_contact == answer.in_contact && length(felt.god_object - answer.god_object) < kApart_m;
}

template <class Force>
double largest_jump(std::size_t ticks, std::size_t in_a_ms, Force force) {
  double largest = 0;
  for (std::size_t i = in_a_ms; i < ticks; ++i)
    largest = std::max(largest, length(force(i) - force(i - in_a_ms)));
  return largest;
}

}  // namespace

double error_of(const Feel& felt, const TrueBody::Tick& truth, bool is_double) {
  double least = length(felt.god_object - truth.feel.god_object);
  for (const Feel& other : truth.others_for(is_double))
    least = std::min(least, length(felt.god_object - other.god_object));
  return least;
}

Metrics judge(const Way& way, double rate_hz, const std::vector<Feel>& felt, const std::vector<TrueBody::Tick>& truth,
              const TrueBody& body, const ReferenceFriction& friction, bool is_double) {
  Metrics m;
  CarriedWay carried(body, friction, is_double ? kTieOfDoubles : kTie);
  m.ticks = way.size();
  std::vector<double> god_object, judged, force, share, direction;
  bool was_lost = false;
  std::uint64_t tied = 0, equal = 0, in_floats = 0, unjudged = 0, lost = 0, wrong = 0, noticeable = 0, phantoms = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Feel &f = felt[i], &t = truth[i].feel;
    const std::span<const Feel> others = truth[i].others_for(is_double);
    m.transitions += f.transitions;
    m.carried_ticks += f.is_carried;
    const OnWay on_way = carried.next(way, i, felt, truth);
    m.astray_ticks += on_way == OnWay::no && error_of(f, truth[i], is_double) >= kApart_m;
    god_object.push_back(length(f.god_object - t.god_object));
    judged.push_back(error_of(f, truth[i], is_double));
    force.push_back(length(f.force - t.force));
    if (!t.in_contact) {
      phantoms += length(f.force) > kTouch_m * kStiffness_n_per_m &&
                  std::none_of(others.begin(), others.end(), [](const Feel& other) { return other.in_contact; });
      was_lost = false;
      continue;
    }
    ++m.contact_ticks;
    if (!is_at(f, t)) {
      const bool is_in_floats = !is_double && truth[i].in_floats && is_at(f, *truth[i].in_floats);
      in_floats += is_in_floats;
      const bool is_tied =
          !is_in_floats && std::any_of(others.begin(), others.end(), [&](const Feel& other) { return is_at(f, other); });
      tied += is_tied;
      const double farther_m = length(f.god_object - way[i]) - length(t.god_object - way[i]);
      equal += is_tied && f.in_contact && friction.mu_static == 0 && std::abs(farther_m) <= kEqual_m;
    }
    const double true_force = length(t.force);
    const bool is_through_all =
        is_lost(f, t) && std::all_of(others.begin(), others.end(), [&](const Feel& other) { return is_lost(f, other); });
    const bool is_through = is_through_all && (!f.is_carried || on_way == OnWay::no);
    lost += is_through;
    m.push_throughs += is_through && !was_lost;
    was_lost = is_through;
    unjudged += is_through_all && on_way == OnWay::unknown;
    wrong += !f.in_contact || body.distance_to(truth[i].state, truth[i].feature, f.god_object) > kWrongFeature_m;
    if (true_force > 0) {
      share.push_back(force.back() / true_force);
      noticeable += share.back() > kNoticeableForce;
    }
    if (f.in_contact && length(f.force) > 0 && true_force > 0) direction.push_back(angle_deg(f.force, t.force));
  }
  const double contact = std::max<double>(1, static_cast<double>(m.contact_ticks));
  m.tied_share = static_cast<double>(tied) / contact;
  m.equal_share = static_cast<double>(equal) / contact;
  m.in_floats_share = static_cast<double>(in_floats) / contact;
  m.unjudged_share = static_cast<double>(unjudged) / contact;
  m.judged_rms_m = rms(judged);
  m.god_object_rms_m = rms(god_object);
  m.god_object_p50_m = at(god_object, 0.5);
  m.god_object_p99_m = at(god_object, 0.99);
  m.god_object_max_m = at(god_object, 1);
  m.force_rms_n = rms(force);
  m.force_max_n = at(force, 1);
  m.force_share_p99 = at(share, 0.99);
  m.noticeable_share = static_cast<double>(noticeable) / contact;
  m.direction_p99_deg = at(direction, 0.99);
  m.direction_max_deg = at(direction, 1);
  const auto in_a_ms = std::max<std::size_t>(1, static_cast<std::size_t>(rate_hz * 1e-3 + 0.5));
  m.jump_n_per_ms = largest_jump(way.size(), in_a_ms, [&](std::size_t i) { return felt[i].force; });
  m.true_jump_n_per_ms = largest_jump(way.size(), in_a_ms, [&](std::size_t i) { return truth[i].feel.force; });
  m.wrong_feature_share = static_cast<double>(wrong) / contact;
  m.push_through_share = static_cast<double>(lost) / contact;
  m.phantom_share = static_cast<double>(phantoms) / std::max<double>(1, static_cast<double>(m.ticks - m.contact_ticks));
  return m;
}

std::vector<Feel> feel_along(Contender& contender, const Way& way) {
  std::vector<Feel> felt(way.size());
  contender.reset();
  for (std::size_t i = 0; i < way.size(); ++i)
    contender.step(way[i], felt[i]);
  return felt;
}

LoopEnergy energy_of_loop(Contender& contender, const Way& way) {
  LoopEnergy energy;
  contender.reset();
  Feel feel;
  contender.step(way[0], feel);
  const std::size_t last = way.size() - 1;
  for (std::size_t k = 1; k <= 2 * last; ++k) {
    const Point& from = way[k - 1 <= last ? k - 1 : 2 * last - (k - 1)];
    const Point& to = way[k <= last ? k : 2 * last - k];
    const Point step = to - from;
    energy.work_j += dot(feel.force, step);
    energy.bound_j += kStiffness_n_per_m * dot(step, step) / 2;
    const bool was_free = !feel.in_contact;
    contender.step(to, feel);
    if (!was_free || !feel.in_contact) continue;
    const Point depth = feel.god_object - to;
    energy.bound_j += kStiffness_n_per_m * dot(depth, depth) / 2;
  }
  return energy;
}

double creep_m(Contender& contender, const Way& way, const std::vector<TrueBody::Tick>& truth) {
  constexpr std::size_t kPlaces = 5;
  constexpr int kSettle = 3, kLongestWalk = 5000, kTicks = 500;
  double largest = 0;
  contender.reset();
  Feel feel;
  std::size_t next = way.size() / (2 * kPlaces);
  for (std::size_t i = 0; i < way.size(); ++i) {
    contender.step(way[i], feel);
    if (i < next || !truth[i].feel.in_contact) continue;
    next = i + way.size() / kPlaces;
    for (int tick = 0; tick < kSettle || (feel.is_carried && tick < kLongestWalk); ++tick)
      contender.step(way[i], feel);
    const Point settled = feel.god_object;
    for (int tick = 0; tick < kTicks; ++tick) {
      contender.step(way[i], feel);
      largest = std::max(largest, length(feel.god_object - settled));
    }
  }
  return largest;
}

}  // namespace fdcg::test
