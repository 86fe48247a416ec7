// SPDX-License-Identifier: Apache-2.0
#include "adversary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fdcg::test {
namespace {

constexpr std::size_t kMostHips = 5;
constexpr std::size_t kPopulation = 12;
constexpr double kFreshShare = 0.3;  // of the cases that are not climbed to

double score(AdversaryGoal goal, const AdversaryFind& find) {
  if (goal == AdversaryGoal::transitions) return find.transitions;
  return goal == AdversaryGoal::error ? find.ulps : find.backward_ulps();
}

}  // namespace

const char* name_of(AdversaryGoal goal) {
  switch (goal) {
    case AdversaryGoal::error:
      return "error";
    case AdversaryGoal::backward_error:
      return "backward error";
    default:
      return "transitions";
  }
}

Adversary::Adversary(const fdcg_graph& graph, const bake::PolygonSoup& soup, std::uint64_t seed)
    : soup_(soup), random_(seed), replay_(graph, contact_params(0, 0)) {
  replay_.explains_ties = false;
  for (const bake::Vec3& p : soup.points)
    size_ = std::max({size_, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

AdversaryFind Adversary::search(AdversaryGoal goal, int cases) {
  std::vector<AdversaryFind> best;  // worst first
  for (int i = 0; i < cases; ++i) {
    const bool is_fresh = best.size() < kPopulation || random_.chance(kFreshShare);
    const AdversaryCase way = is_fresh ? fresh() : changed(best[random_.below(static_cast<std::uint32_t>(best.size()))].way);
    AdversaryFind find = judged(goal, way);
    const auto place = std::find_if(best.begin(), best.end(),
                                    [&](const AdversaryFind& other) { return score(goal, find) > score(goal, other); });
    if (place == best.end() && best.size() >= kPopulation) continue;
    best.insert(place, std::move(find));
    if (best.size() > kPopulation) best.pop_back();
  }
  return best.empty() ? AdversaryFind{} : best.front();
}

AdversaryFind Adversary::judged(AdversaryGoal goal, const AdversaryCase& way) {
  replay_.restart(contact_params(way.mu_static, way.mu_dynamic));
  AdversaryFind worst;
  worst.way = way;
  for (const Hip& hip : way.hips) {
    replay_.step(hip);
    ++ticks;
    const TickError& tick = replay_.last();
    if (tick.verdict == TickError::Verdict::wrong && wrong++ == 0) first_wrong = replay_.errors.first_wrong;
    if (tick.verdict != TickError::Verdict::agrees || !tick.is_contact) continue;
    AdversaryFind here;
    here.ulps = tick.ulps;
    here.conditioning = tick.conditioning;
    here.transitions = tick.step.transitions;
    if (here.conditioning <= kMostWellPosed) well_posed_ulps = std::max(well_posed_ulps, here.ulps);
    if (score(goal, here) <= score(goal, worst)) continue;
    here.way = way;
    here.what = replay_.errors.worst;
    worst = std::move(here);
  }
  return worst;
}

AdversaryCase Adversary::fresh() {
  AdversaryCase way;
  set_friction(way);
  const std::size_t count = 2 + random_.below(kMostHips - 1);
  while (way.hips.size() < count)
    way.hips.push_back(hip_after(way.hips));
  return way;
}

AdversaryCase Adversary::changed(AdversaryCase way) {
  for (std::uint32_t i = 1 + random_.below(3); i > 0; --i) {
    const std::size_t at = random_.below(static_cast<std::uint32_t>(way.hips.size()));
    switch (random_.below(10)) {
      case 0:
        set_friction(way);
        break;
      case 1:
        if (way.hips.size() < kMostHips)
          way.hips.insert(way.hips.begin() + static_cast<std::ptrdiff_t>(at), hip_after(way.hips));
        break;
      case 2:
        if (way.hips.size() > 2) way.hips.erase(way.hips.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 3:
        way.hips[at] = hip_after(way.hips);
        break;
      case 4:
        for (double& c : way.hips[at])
          c = std::nextafter(c, (random_.chance(0.5) ? 1 : -1) * std::numeric_limits<double>::infinity());
        break;
      default:
        way.hips[at] = shaken(way.hips[at], -12, 0);
    }
  }
  return way;
}

void Adversary::set_friction(AdversaryCase& way) {
  constexpr double kStatic[] = {0, 1e-6, 1e-3, 0.1, 0.6, 2};
  way.mu_static = kStatic[random_.below(6)];
  way.mu_dynamic = way.mu_static * (random_.chance(0.5) ? 1 : 0.7);
}

Hip Adversary::corner() {
  return point_of(soup_.points[soup_.corners[random_.below(static_cast<std::uint32_t>(soup_.corners.size()))]]);
}

Hip Adversary::on_edge() {
  const std::uint32_t f = random_.below(static_cast<std::uint32_t>(soup_.face_count()));
  const std::uint32_t first = soup_.face_first[f], n = soup_.face_first[f + 1] - first, k = random_.below(n);
  const Hip a = point_of(soup_.points[soup_.corners[first + k]]),
            b = point_of(soup_.points[soup_.corners[first + (k + 1) % n]]);
  const double part = random_.unit();
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
}

// By ten to a power between the two, of the size.
Hip Adversary::shaken(Hip p, double least_power, double most_power) {
  const bake::Vec3 d = random_.direction();
  const double by = size_ * std::pow(10, random_.uniform(least_power, most_power));
  return {p[0] + by * d.x, p[1] + by * d.y, p[2] + by * d.z};
}

Hip Adversary::hip_after(const std::vector<Hip>& hips) {
  const auto beyond = [&](const Hip& through, double part) {
    const Hip& from = hips.back();
    return Hip{from[0] + part * (through[0] - from[0]), from[1] + part * (through[1] - from[1]),
               from[2] + part * (through[2] - from[2])};
  };
  switch (random_.below(hips.empty() ? 4 : 8)) {
    case 0:
      return shaken(corner(), -16, 0);
    case 1:
    case 2:
      return shaken(on_edge(), -16, -0.5);
    case 3:
      return shaken({}, 0, 0.3);
    case 4:
      return shaken(hips.back(), -12, 0);
    case 5:
      return beyond(corner(), random_.chance(0.5) ? 2 : 1.25);  // aims at a corner
    case 6:
      return shaken(beyond(on_edge(), random_.uniform(0.5, 2)), -16, -2);  // grazes an edge
    default: {
      Hip p = hips.back();  // keeps a coordinate of a corner: near planes
      p[random_.below(3)] = corner()[random_.below(3)];
      return p;
    }
  }
}

}  // namespace fdcg::test
