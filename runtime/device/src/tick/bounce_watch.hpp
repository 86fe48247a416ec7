// SPDX-License-Identifier: Apache-2.0
// Bounces that feed themselves, seen from places alone: whatever the mass of the hand, a passive surface never throws it back
// faster than it came. A hand that taps leaves slower than it came; a loop whose forces come late leaves faster, touch after
// touch. So it is seen without the round trip too, which devices that do not echo what they are sent leave unknown. A pure
// function of places, forces and times. No heap, no lock, bounded work.
#pragma once

#include <cstdint>

namespace fdcg::dev {

inline constexpr double kSpeedS = 0.005;         // over which a speed is measured
inline constexpr double kLongestFlightS = 0.15;  // a longer one ends a row of touches

// What counts as shaking: so many touches in a row that are left faster than `throw_share` of the speed of arrival. A touch
// that is longer is the hand's own doing.
struct BounceLimits {
  double throw_share, longest_touch_s;
  int throws;
};
inline constexpr BounceLimits kBounces = {1.1, 0.08, 2};
inline constexpr BounceLimits kCalmedBounces = {0.9, 0.15, 1};  // after a calming: one that fades too slowly is enough

class BounceWatch {
 public:
  void begin(double period_s);
  // A tick with a good report: the tip, and the force that the scene wants there; device's frame. True: shaking.
  bool step(const double tip_m[3], std::uint64_t now_ns, const double force_n[3], const BounceLimits& limits);
  std::uint64_t since_ns() const { return first_ns_; }  // of the row's first touch

 private:
  static constexpr std::uint32_t kPlaces = 64;
  struct Place {
    std::uint64_t ns = 0;
    double tip_m[3] = {};
  };
  double speed() const;
  void arrive(std::uint64_t now_ns, const double force_n[3]);
  bool is_thrown(const BounceLimits& limits) const;

  std::uint32_t back_ = 1;  // places over which a speed is measured
  Place places_[kPlaces];   // a ring
  std::uint32_t place_count_ = 0;
  bool is_touching_ = false;
  double direction_[3] = {};    // of the force at arrival, one long
  double arrival_m_per_s_ = 0;  // towards the surface; 0: not known
  std::uint32_t flown_ = 0;     // places since the force became zero
  std::uint64_t arrived_ns_ = 0, left_ns_ = 0, first_ns_ = 0;
  int throws_ = 0;
};

}  // namespace fdcg::dev
