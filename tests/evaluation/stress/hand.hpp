// SPDX-License-Identifier: Apache-2.0
// Hands that look for trouble: each motion is one kind of it that docs/internals/contact-model.md#9-what-holds-of-every-tick
// names.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hip_walk.hpp"
#include "random.hpp"
#include "specimen.hpp"

namespace fdcg::test {

enum class Motion : std::uint8_t {
  wander,      // HipWalk: thirteen habits in turns
  slide,       // under the surface at a depth, in a direction that turns, GO following
  tremor,      // 0.2 % of the size about a point in a corner, pressed in more and less
  dive,        // into a corner along its normal, and round its axis
  on_planes,   // exactly on an edge, a corner, a face's plane, a Voronoi plane; within units in the last place of them
  creep,       // steps of 1e-12 of the size through a feature
  aim,         // from outside at a feature and through it, exactly or within units in the last place
  jump,        // across the whole object, far out and back
  encoder,     // multiples of a quantum
  object,      // a still hand, and an object that swings, turns and rises
  inside,      // starts inside, leaves, comes back
  not_finite,  // wanders, and now and then is NaN, infinite, far away, or of denormal size
  approach,    // at 0.1, 0.3 or 1 m/s and 1 kHz at a corner of the focus, some millimetres on, and back (pointed_bodies.hpp)
  count
};
std::string_view name_of(Motion motion);

class Hand {
 public:
  Hand(const Specimen& specimen, std::uint64_t seed);

  // Begins another motion with a new contact. Returns how many ticks it is to last, at most kMostTicks.
  std::uint32_t begin(Motion motion);
  static constexpr std::uint32_t kMostTicks = 1200;

  // The next HIP in metres in the object's frame. `god_object`: local, where the contact is now; is_free: it is in no contact.
  Hip next(const Hip& god_object, bool is_free);

 private:
  Hip local_next(const Hip& god_object, bool is_free);
  Hip slide(const Hip& god_object, bool is_free);
  Hip tremor();
  Hip dive();
  Hip on_planes();
  Hip creep();
  Hip aim();
  Hip jump();
  Hip encoder(bool is_free);
  Hip object();
  Hip not_finite();
  void begin_approach();

  void pick_side();
  Hip wander(const Hip& god_object);
  Hip direction();
  Hip around(const Hip& p, double length);  // at that distance, anywhere
  Hip inside_point();
  Hip surface_point();
  Hip anywhere(double sizes);
  Hip nudged(Hip p);
  std::uint32_t some_corner();
  double share(double low, double high);  // of the size, 10^low to 10^high
  Hip metres(const Hip& local) const;

  const Specimen& specimen_;
  Random random_;
  HipWalk walk_;
  Motion motion_ = Motion::wander;
  std::uint32_t tick_ = 0;
  Hip middle_{};
  double size_ = 0;  // half of the bounds' longest side
  bool is_float_ = false;

  // what the motion at hand goes by
  Hip anchor_{}, heading_{}, normal_{}, place_{};
  double depth_ = 0, amount_ = 0, phase_ = 0;
  std::uint32_t node_ = 0, side_ = 0, corner_ = 0, stay_ = 0;
  std::vector<Hip> way_;
};

}  // namespace fdcg::test
