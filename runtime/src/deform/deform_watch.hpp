// SPDX-License-Identifier: Apache-2.0
// Clear balls that a deformable mesh tracks: no box reaches into one. A motion inside the boxes brings no face nearer, so that
// such a ball stays valid however often the surface moves, until a corner leaves its boxes and makes one of them reach into
// it.
#pragma once

#include "deform/deform_boxes.hpp"
#include "step/contact_internals.hpp"

namespace fdcg {

// Of a mesh at once; further contacts replace the balls of others, which then search for new ones. 640 bytes.
inline constexpr uint32_t kWatchedBalls = 16;

struct WatchedBall {
  double centre[3], radius2;  // as in the contact that owns the ball; radius2 0: unused
  double reach2;              // tree units, squared: the radius, and what rounding may do to a way inside the ball
};

// All of a mesh. The mesh has no references to contacts, which may be copied: a ball is identified by its numbers.
struct WatchedBalls {
  WatchedBall ball[kWatchedBalls];
  uint32_t used, next;

  [[nodiscard]] bool holds(uint32_t place, const ClearBall& of_contact) const {
    const WatchedBall& here = ball[place % kWatchedBalls];
    return of_contact.radius2 > 0 && here.radius2 == of_contact.radius2 && here.centre[0] == of_contact.centre[0] &&
           here.centre[1] == of_contact.centre[1] && here.centre[2] == of_contact.centre[2];
  }

  // In a free place, or in place of another. Returns the index.
  uint32_t add(const WatchedBall& added) {
    uint32_t place = 0;
    while (place < used && ball[place].radius2 > 0)
      ++place;
    if (place == kWatchedBalls) place = next++ % kWatchedBalls;
    if (place == used) ++used;
    ball[place] = added;
    return place;
  }
  void remove(uint32_t place) { ball[place % kWatchedBalls].radius2 = ball[place % kWatchedBalls].reach2 = 0; }

  // A box has changed: balls that it reaches into are dropped.
  void give_up(const TreeBox& box, double per_tree_unit) {
    for (uint32_t i = 0; i < used; ++i) {
      double gap2 = 0;
      for (int k = 0; k < 3; ++k) {
        const double at = ball[i].centre[k] * per_tree_unit;
        const double gap = at < box.low[k] ? box.low[k] - at : at > box.high[k] ? at - box.high[k] : 0;
        gap2 += gap * gap;
      }
      if (gap2 < ball[i].reach2) remove(i);
    }
  }
};

}  // namespace fdcg
