// SPDX-License-Identifier: Apache-2.0
// From the record of section MASS to metres, and what such a record cannot say. The compiler asks the same of what it writes.
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

inline fdcg_mass mass_in_metres(const fdcg_mass_record& record, const double (&origin)[3], double metres_per_unit) {
  const double s = metres_per_unit;
  fdcg_mass mass = {};
  mass.volume_m3 = record.volume * s * s * s;
  for (int k = 0; k < 3; ++k)
    mass.centroid_m[k] = (record.centroid[k] + origin[k]) * s;
  for (int k = 0; k < 6; ++k)
    mass.inertia_per_density_m5[k] = record.inertia[k] * s * s * s * s * s;
  mass.density_kg_per_m3 = record.density_kg_per_m3;
  mass.mass_kg = record.mass_kg;
  return mass;
}

// A solid's inertia: of no axis more than of the two others together, of no product more than half of the third axis.
// Rounded once each, so the bounds may be passed by rounding alone.
inline bool is_inertia(const double (&inertia)[6], double least, double largest) {
  constexpr double kSlack = 1 + 1e-12;
  const double sum = inertia[0] + inertia[1] + inertia[2];
  for (int k = 0; k < 3; ++k) {
    const double axis = inertia[k], product = inertia[5 - k];  // xx yy zz xy xz yz: yz goes with xx
    if (!(axis >= least && axis <= largest)) return false;
    if (!(axis - (sum - axis) <= (kSlack - 1) * sum)) return false;
    if (!(2 * product <= axis * kSlack && -2 * product <= axis * kSlack)) return false;
  }
  return true;
}

// What is wrong with the properties; null: nothing.
inline const char* mass_fault(const fdcg_mass& mass) {
  constexpr double kLeast = 2.2250738585072014e-308, kLargest = 1e308;  // of normal numbers
  if (!(mass.volume_m3 >= kLeast && mass.volume_m3 <= kLargest)) return "the volume is out of range";
  for (const double x : mass.centroid_m) {
    if (!(x >= -kLargest && x <= kLargest)) return "the centroid is out of range";
  }
  if (!is_inertia(mass.inertia_per_density_m5, kLeast, kLargest / 4)) return "the inertia is no solid's, or out of range";
  const double density = mass.density_kg_per_m3, kg = mass.mass_kg;
  if (density == 0 && kg == 0) return nullptr;
  constexpr double kAgree = 1e-9;  // far above rounding, far below what matters
  if (!(density >= kLeast && density <= kLargest && kg >= kLeast && kg <= kLargest))
    return "the density or mass is out of range";
  const double off = density * mass.volume_m3 / kg - 1;
  return off <= kAgree && off >= -kAgree ? nullptr : "the mass is not that of the volume at the density";
}

// Section MASS of an opened file; FDCG_OK where it has none.
fdcg_status verify_mass(const fdcg_header& header, fdcg_error* error);

}  // namespace fdcg
