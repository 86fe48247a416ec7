// SPDX-License-Identifier: Apache-2.0
// Damping of the spring between hand and god-object (contact-model RESP-2), for graphs and surfaces.
#pragma once

#include "fdcg/fdcg.h"
#include "shared/vec.hpp"

namespace fdcg {

// Where damping takes from the spring: the speed along it, times the coefficient. Newtons per metre, >= 0 in all.
inline double damped(const fdcg_params& params, double stiffness, Vec3<double> spring, Vec3<double> moved) {
  const double length2 = dot(spring, spring);
  if (!(length2 > 0)) return stiffness;
  const double left = stiffness - params.damping_n_s_per_m * (dot(moved, spring) / length2) / params.tick_s;
  return left > 0 ? left : 0;  // never adhesive
}

}  // namespace fdcg
