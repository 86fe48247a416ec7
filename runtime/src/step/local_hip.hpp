// SPDX-License-Identifier: Apache-2.0
// The HIP as the step takes it: in the graph's frame, in its numbers (contact-model TICK-2, TICK-4); and places of a contact.
#pragma once

#include "base/mutation.hpp"
#include "graph/tolerances.hpp"
#include "step/near_zero.hpp"

namespace fdcg {
namespace {

// A double rounded to a float, in a way that no compiler sees through: GCC 12's basic-block vectoriser (-O2) drops the rounding
// of a double to float and back where it sees both. In a register where that can be said, since a call or a way through memory
// costs a tenth of a step.
inline float rounded(double x) {
#if defined(__SSE2__)
  float narrow = static_cast<float>(x);
  __asm__("" : "+x"(narrow));
#else
  volatile float narrow = static_cast<float>(x);
#endif
  return narrow;
}
inline void round_to(Vec3<double> from, Vec3<float>* to) {
  *to = {rounded(from.x), rounded(from.y), rounded(from.z)};
  if (FDCG_MUTANT("float-rounding-lost")) to->x = rounded(from.x * (1 - 0x1p-24));
}
inline void round_to(Vec3<double> from, Vec3<double>* to) {
  *to = from;
}

// All three at most `limit` in size; false for NaN. One branch.
inline bool is_within(Vec3<double> p, double limit) {
  const int x = absolute(p.x) <= limit, y = absolute(p.y) <= limit, z = absolute(p.z) <= limit;
  return (x & y & z) != 0;
}

// The HIP in the graph's frame, not yet rounded to its reals. False, without an overflow on the way, where it is not usable.
// Coordinate by coordinate: in an array the compiler would store them one by one and load two at once, which waits for the
// stores.
inline bool to_local(const fdcg_header& header, const double hip_object_m[3], double farthest, Vec3<double>* hip) {
  Vec3<double> local = {hip_object_m[0], hip_object_m[1], hip_object_m[2]};
  const double unit_m = header.metres_per_unit;
  if (unit_m != 1) {  // a division takes as long as the rest of this function
    if (!is_within(local, kFarthestHip_m)) return false;
    local = {local.x / unit_m, local.y / unit_m, local.z / unit_m};
  }
  local = local - vec(header.origin);
  if (!is_within(local, farthest)) return false;
  const double least = kLeastShare * header.extent;
  if (has_below(least, local)) local = {zero_below(least, local.x), zero_below(least, local.y), zero_below(least, local.z)};
  *hip = local;
  return true;
}

// A place of a contact, which is kept in double whatever the graph's numbers are.
template <class Real>
inline Vec3<Real> narrow(const double (&a)[3]) {
  return {static_cast<Real>(a[0]), static_cast<Real>(a[1]), static_cast<Real>(a[2])};
}

}  // namespace
}  // namespace fdcg
