// SPDX-License-Identifier: Apache-2.0
// What a contact keeps from tick to tick and shows to nobody: the bytes of fdcg_contact::internals. Zeros are its start.
#pragma once

#include <stddef.h>

#include "fdcg/fdcg.h"

namespace fdcg {

// A sweep through free space that one tick could not finish (contact-model BOUND-2). The path is frozen: from the god-object,
// which stays where it is, to `target`. Later ticks test the faces in index order, from `next_leaf` on, until all that the path
// may meet are done. Then the contact is placed on what was met first, or at the target, and goes on from there to the newest
// HIP.
struct CarriedSweep {
  double target[3];        // local
  double fraction;         // of the path: where the first feature met so far is entered
  uint32_t state;          // that feature: FDCG_FREE if nothing is met so far
  uint32_t feature;        // ... node or connection
  uint32_t node;           // ... the node through which it was met
  uint32_t left_state;     // the feature that the path starts on; FDCG_FREE: none
  uint32_t left_feature;   // its number
  uint32_t next_leaf;      // leaf of the hierarchy, or node where there is none
  uint32_t is_carried;     // 0: there is no such sweep
  uint32_t stalled_ticks;  // consecutive ticks that spent the rules' work and moved nothing
};

// A ball in free space that no faces touch but a few; if there is one, the last HIP is in it.
struct ClearBall {
  double centre[3];     // local
  double radius2;       // squared; 0: there is none
  uint16_t wait;        // ticks until the next search for one
  uint16_t next_wait;   // how long to wait if that search finds none
  uint16_t near_count;  // of the nodes that reach into it
  uint16_t lists_all;   // 1: all of them are listed; 0: one may stand for several in one plane
};

// The field of normals (normal_field.hpp) of the face that a shaded contact is on. It follows from the graph: what is lost of
// it is made anew, to the same bits.
struct KeptField {
  uint64_t of_node;   // its number and 1; 0: none is kept
  double normals[9];  // a NormalField
};

inline void end_clear_ball(ClearBall* ball) {
  ball->radius2 = 0;
  ball->near_count = ball->lists_all = 0;
}

// The nodes that reach into the clear ball, in the bytes of the field: no contact in free space has one.
inline constexpr uint32_t kMostNear = 8;
struct NearNodes {
  uint64_t of_node;  // 0: no field is kept
  uint32_t node[kMostNear];
  uint32_t prefetched;  // the face around whose neighbours all has been prefetched; no contact on a face has a clear ball
};

struct ContactInternals {
  uint64_t on;               // marks the graph, deformable mesh or kind of surface that it is on (admit.hpp). 0: not yet
  uint32_t seat_state;       // FDCG_EDGE or FDCG_VERTEX: where the god-object was placed and still is; else FDCG_FREE
  uint32_t seat_feature;     // its number
  double slip_m_per_s;       // the speed that friction has followed to, where it lags; else 0
  double stiffness_n_per_m;  // current stiffness, where materials, presliding or shading count. 0: a new contact
  CarriedSweep sweep;        // what the last tick left to do
  ClearBall clear_ball;      // where no sweep is needed
  union {
    KeptField field;  // where shading counts
    NearNodes near;   // where the clear ball counts
  };
};
static_assert(sizeof(ContactInternals) == FDCG_CONTACT_INTERNAL_BYTES);
static_assert(offsetof(fdcg_contact, internals) % alignof(ContactInternals) == 0 &&
              alignof(fdcg_contact) % alignof(ContactInternals) == 0);

inline ContactInternals& internals_of(fdcg_contact& contact) {
  return *reinterpret_cast<ContactInternals*>(contact.internals);
}
inline const ContactInternals& internals_of(const fdcg_contact& contact) {
  return *reinterpret_cast<const ContactInternals*>(contact.internals);
}

// Leaves out of what is kept what follows from the graph.
inline void keep_no_field(ContactInternals* inner) {
  const NearNodes near = inner->clear_ball.near_count != 0 ? inner->near : NearNodes{};  // in free space nothing is prefetched
  inner->field = {};
  inner->near = near;
}

}  // namespace fdcg
