// SPDX-License-Identifier: Apache-2.0
// Coulomb friction as a cone (Melder 2004, section 2 and figure 4; contact-model FRIC-1 to FRIC-5): the god-object rests while
// its gap to the surface point is within the friction coefficient times the load that presses it on. No angle is ever computed.
#pragma once

#include "base/config.hpp"
#include "base/mutation.hpp"
#include "shared/vec.hpp"
#include "step/friction_terms.hpp"

namespace fdcg {

template <class Real>
inline Real square(Real a) {
  return a * a;
}

// What friction makes of a gap: rest, or slip until it is `gap`.
template <class Real>
struct Slip {
  bool is_rest;
  Real gap;
};

// Two coefficients.
template <class Real>
struct PlainFriction {
  Real mu_static, mu_dynamic;
  bool has_wedge;    // on edges: contact-model EDGE-4
  bool is_slipping;  // dynamic friction holds

  // contact-model FRIC-1 to FRIC-4. `gap2` is the squared distance of the god-object from the surface point, `load` the depth
  // that presses it on. Slipping
  // starts beyond mu_static and ends below mu_dynamic by a factor of 1 - 2^-20, because a slipping god-object sits exactly on
  // the dynamic circle and rounding must not toss a coin every tick; for the same reason it is not placed anew for less than
  // the rounding of its own place. Squares, so that rest costs no root.
  Slip<Real> slip(const Vec3<Real>& god_object, Real gap2, Real load) {
    constexpr Real kStickAgain = Real(kStickAgainShare);
    const Real gap = mu_dynamic * load;
    if (is_slipping) {
      if (gap2 <= square(FDCG_MUTANT("stick-factor") ? gap + circle_rounding(god_object, gap) : kStickAgain * gap))
        is_slipping = false;
    } else if (gap2 > square(mu_static * load)) {
      is_slipping = true;
      if (FDCG_MUTANT("slip-later")) return {false, mu_static * load};
    }
    if (FDCG_MUTANT("rest-untouched")) return {false, is_slipping ? gap : root(gap2)};
    return {!is_slipping || gap2 <= square(gap + circle_rounding(god_object, gap)), gap};
  }
};

// The same, or with terms.
template <class Real>
struct Friction : PlainFriction<Real> {
  FrictionTerms* terms = nullptr;  // null: the two coefficients are all there is

  Slip<Real> slip(const Vec3<Real>& god_object, Real gap2, Real load) {
    if constexpr (FDCG_WITH_FRICTION_TERMS) {
      if (terms != nullptr) return slip_with_terms(god_object, gap2, load);
    }
    return PlainFriction<Real>::slip(god_object, gap2, load);
  }

 private:
  [[gnu::noinline, gnu::cold]] Slip<Real> slip_with_terms(const Vec3<Real>& god_object, Real gap2, Real load) {
    const TermSlip slip =
        terms->slip({god_object.x, god_object.y, god_object.z}, gap2, load, RealLimits<Real>::kEpsilon, &this->is_slipping);
    return {slip.is_rest, static_cast<Real>(slip.gap)};
  }
};

// Of a tick that is known to have no terms; where the library is built for size, one kind serves all.
#if FDCG_WITH_FRICTION_TERMS && !defined(__OPTIMIZE_SIZE__)
template <class Real>
using QuickFriction = PlainFriction<Real>;
#else
template <class Real>
using QuickFriction = Friction<Real>;
#endif

}  // namespace fdcg
