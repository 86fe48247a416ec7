// SPDX-License-Identifier: Apache-2.0
// One contact whose friction may change from tick to tick, as the shipped step has it.
#pragma once

#include <cstring>

#include "contact_rig.hpp"

namespace fdcg::test {

struct Pressed {
  const fdcg_graph* graph;
  fdcg_contact contact{};
  fdcg_result result{};

  const fdcg_result& step(const fdcg_params& params, const Hip& hip) {
    fdcg_step(graph, &params, &contact, hip.data(), &result);
    return result;
  }
  // Brings the HIP from `above`, in free space, to `below` without friction, so that the god-object is straight above it; there
  // friction sets in and holds it.
  void press(const fdcg_params& params, const Hip& above, const Hip& below) {
    const fdcg_params smooth = contact_params(0, 0);
    step(smooth, above);
    step(smooth, below);
    step(params, below);
  }
  [[nodiscard]] bool is_at(const double (&god_object)[3]) const {
    return std::memcmp(contact.god_object, god_object, sizeof god_object) == 0;
  }
};

// The bar that Coulomb's ratio has to meet, and the same for a number type of fewer digits.
constexpr double kRatioBar = 1e-12;
inline double ratio_bar(bake::Precision precision) {
  return precision == bake::Precision::f64 ? kRatioBar : kRatioBar * 0x1p29;  // 2^29: FLT_EPSILON / DBL_EPSILON
}
inline const char* name_of(bake::Precision precision) {
  return precision == bake::Precision::f64 ? "f64" : "f32";
}
constexpr bake::Precision kBothPrecisions[] = {bake::Precision::f64, bake::Precision::f32};

}  // namespace fdcg::test
