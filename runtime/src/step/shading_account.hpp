// SPDX-License-Identifier: Apache-2.0
// contact-model SHADE-5: the energy of a contact that is shaded. A turned force is no gradient: round a loop it could do work.
// So the spring may never store more than it did before the rules moved the god-object, and what earlier moves have left: the
// stiffness gives way to that. What a contact keeps is the stiffness that would store all of it, at most twice what the
// material says; what is felt is the smaller of the two.
#pragma once

#include "step/presliding.hpp"

namespace fdcg {

// Twice the energy that a tick's moves may leave, of a contact that keeps the stiffness `kept`. `before`: twice what a spring
// of 1 N/m stores before them, at this HIP; `last`: at the last tick's.
inline double may_store(double kept, double own, double before, double last) {
  const double felt = smaller(kept, own);
  return felt * before + (kept - felt) * last;
}

// The stiffness to keep: `now` is twice what a spring of 1 N/m stores after the moves. A contact that has not moved, and has
// nothing left over, keeps its stiffness: it would be the same but for rounding, which would go on for ever.
inline double kept_stiffness(double kept, double own, double may, double now, bool is_still) {
  if (is_still && kept <= own) return kept;
  return 2 * own * now <= may ? 2 * own : may / now;
}

// The stiffness that is felt, and in *kept the one that is kept. `was`, `before`, `last_hip`: where the tick found the contact.
template <class Geometry>
[[gnu::noinline, gnu::cold]] double settle_shaded(const Walk<Geometry>& walk, Feature was, Vec3<double> before,
                                                  Vec3<double> last_hip, double* kept) {
  FrictionTerms& terms = *walk.friction.terms;
  const Vec3<double> hip = widen(walk.hip), now = widen(walk.god_object);
  const double held = terms.held_stiffness;
  double may = 0;
  terms.held_stiffness = 0;  // at a vertex the material of a face beside it
  if (held > 0) {
    select_material(walk, was);
    const Vec3<double> yielded = presliding_offset(walk, was, before);
    may = may_store(held, terms.material.stiffness_n_per_m, stored(terms, before - hip, yielded),
                    stored(terms, before - last_hip, yielded));
  }
  select_material(walk, walk.active);
  terms.yielded = presliding_offset(walk, walk.active, now);
  const double own = terms.material.stiffness_n_per_m;
  const bool is_still = was == walk.active && before.x == now.x && before.y == now.y && before.z == now.z;
  *kept = held > 0 ? kept_stiffness(held, own, may, stored(terms, now - hip, terms.yielded), is_still) : own;
  return smaller(*kept, own);
}

}  // namespace fdcg
