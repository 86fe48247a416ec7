// SPDX-License-Identifier: Apache-2.0
#include "result_law.hpp"

#include <cmath>
#include <limits>

namespace fdcg::test {
namespace {

using Real = long double;
constexpr Real kHalfUlp = 0x1p-53L, kHalfUlpOfFloat = 0x1p-24L;  // of one
constexpr Real kLeastShare = 0x1p-70L;  // of the extent: a coordinate below it may count as 0 (contact-model TICK-8)

bool is_place_said(const fdcg_header& header, const fdcg_contact& contact, const std::array<double, 3>& hip_m,
                   const fdcg_result& result) {
  const Real unit = header.metres_per_unit;
  for (std::size_t i = 0; i < 3; ++i) {
    const Real place = (Real(contact.god_object[i]) + header.origin[i]) * unit;
    const Real size = (std::abs(Real(contact.god_object[i])) + std::abs(Real(header.origin[i]))) * unit;
    if (!(std::abs(place - result.god_object_m[i]) <= 3 * kHalfUlp * size)) return false;
    const Real in_units = Real(hip_m[i]) / unit, local = in_units - header.origin[i];
    const Real in_file = header.real_bytes == sizeof(float) ? kHalfUlpOfFloat : kHalfUlp;
    const Real rounding = in_file * std::abs(local) + 3 * kHalfUlp * (std::abs(in_units) + std::abs(local));
    if (!(std::abs(local - contact.hip[i]) <= rounding + kLeastShare * Real(header.extent))) return false;
  }
  return true;
}

}  // namespace

ResultLaw result_law(const fdcg_header& header, const fdcg_params& params, const fdcg_contact& contact,
                     const std::array<double, 3>& hip_m, const fdcg_result& result) {
  const bool is_free = contact.state == FDCG_FREE, is_carried = (result.flags & FDCG_RESULT_SWEEP_BOUND) != 0;
  ResultLaw law;
  law.is_of_contact = result.state == contact.state && result.feature == (is_free ? FDCG_NONE : contact.feature) &&
                      result.slipping == contact.slipping && is_place_said(header, contact, hip_m, result);
  if (is_free && !is_carried) law.is_of_contact = law.is_of_contact && contact.slipping == 0;
  const Real k = Real(params.stiffness_n_per_m) * header.metres_per_unit;
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_free && !is_carried && contact.god_object[i] != contact.hip[i]) law.is_of_contact = false;
    const Real force = is_free ? Real(0) : k * (Real(contact.god_object[i]) - contact.hip[i]);
    const Real rounding = 5 * kHalfUlp * std::abs(force) + std::numeric_limits<double>::min();
    if (!(std::abs(force - result.force_n[i]) <= rounding)) law.is_of_spring = false;
  }
  return law;
}

}  // namespace fdcg::test
