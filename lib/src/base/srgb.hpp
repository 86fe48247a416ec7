// SPDX-License-Identifier: Apache-2.0
// Colours as screens have them (IEC 61966-2-1), and linear.
#pragma once

#include <algorithm>
#include <cmath>

namespace fdcg::bake {

// Of a share of 0 to 1; what lies beyond is brought there, what is no number is 1.
[[nodiscard]] inline float linear_of_srgb(double share) {
  if (!(share < 1)) return 1;
  const double s = std::max(share, 0.0);
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

// An opacity, or a colour that is linear.
[[nodiscard]] inline float share_of(double share) {
  return share < 1 ? static_cast<float>(std::max(share, 0.0)) : 1;
}

}  // namespace fdcg::bake
