// SPDX-License-Identifier: Apache-2.0
#include "tick/bounce_watch.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "base/time.hpp"

namespace fdcg::dev {
void BounceWatch::begin(double period_s) {
  *this = BounceWatch();
  const double places = period_s > 0 ? std::nearbyint(kSpeedS / period_s) : 1;
  back_ = static_cast<std::uint32_t>(std::clamp(places, 1.0, kPlaces - 2.0));
}

// Along the force of the touch, away from the surface; over the last places. 0: there are too few.
double BounceWatch::speed() const {
  if (place_count_ <= back_) return 0;
  const Place &to = places_[(place_count_ - 1) % kPlaces], &from = places_[(place_count_ - 1 - back_) % kPlaces];
  const double time_s = seconds(from.ns, to.ns);
  const double way_m[3] = {to.tip_m[0] - from.tip_m[0], to.tip_m[1] - from.tip_m[1], to.tip_m[2] - from.tip_m[2]};
  return time_s > 0 ? dot(way_m, direction_) / time_s : 0;
}

// The places so far are all before the touch.
void BounceWatch::arrive(std::uint64_t now_ns, const double force_n[3]) {
  const double length = std::sqrt(dot(force_n, force_n));
  for (int i = 0; i < 3; ++i)
    direction_[i] = force_n[i] / length;
  const bool goes_on = throws_ > 0 && flown_ > back_ && seconds(left_ns_, now_ns) <= kLongestFlightS;
  if (!goes_on) throws_ = 0;
  if (throws_ == 0) first_ns_ = now_ns;
  arrival_m_per_s_ = std::max(0.0, -speed());
  arrived_ns_ = now_ns;
}

// The last places are all behind the touch.
bool BounceWatch::is_thrown(const BounceLimits& limits) const {
  return arrival_m_per_s_ > 0 && seconds(arrived_ns_, left_ns_) <= limits.longest_touch_s &&
         speed() > limits.throw_share * arrival_m_per_s_;
}

bool BounceWatch::step(const double tip_m[3], std::uint64_t now_ns, const double force_n[3], const BounceLimits& limits) {
  const bool touches = dot(force_n, force_n) > 0;
  if (touches && !is_touching_) arrive(now_ns, force_n);
  if (!touches && is_touching_) {
    left_ns_ = now_ns;
    flown_ = 0;
  }
  is_touching_ = touches;
  Place& place = places_[place_count_++ % kPlaces];
  place.ns = now_ns;
  std::copy_n(tip_m, 3, place.tip_m);
  if (touches || left_ns_ == 0 || ++flown_ != back_ + 1) return false;
  throws_ = is_thrown(limits) ? throws_ + 1 : 0;
  if (throws_ < limits.throws) return false;
  throws_ = 0;
  return true;
}

}  // namespace fdcg::dev
