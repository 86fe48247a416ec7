// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_placing.hpp"

#include <cmath>

namespace fdcg::bake::gltf {

Grain grain_of(const Positions& positions) {
  if (positions.type() == Component::f32) return {0x1p-24, 0};
  const bool is_byte = size_of(positions.type()) == 1;
  // 256 steps are too few for a scan: bytes that are not normalised are taken as a modelling grid, and exact.
  if (!positions.is_normalized()) return {0x1p-53, is_byte ? 0 : 0.5};
  switch (positions.type()) {
    case Component::i8:
      return {0x1p-53, 0.5 / 127};
    case Component::u8:
      return {0x1p-53, 0.5 / 255};
    case Component::i16:
      return {0x1p-53, 0.5 / 32767};
    default:
      return {0x1p-53, 0.5 / 65535};
  }
}

bool composed(const std::array<double, 3>& t, const std::array<double, 4>& q, const std::array<double, 3>& s, Matrix& m) {
  constexpr double kSlack = 0.01;  // of the squared length; the least precise encoding, normalised bytes, is off by 0.008
  const auto [x, y, z, w] = q;
  const double length2 = x * x + y * y + z * z + w * w;
  if (!(std::fabs(length2 - 1) <= kSlack)) return false;
  const double k = 2 / length2;
  m = {s[0] * (1 - k * (y * y + z * z)),
       s[0] * k * (x * y + z * w),
       s[0] * k * (x * z - y * w),
       0,
       s[1] * k * (x * y - z * w),
       s[1] * (1 - k * (x * x + z * z)),
       s[1] * k * (y * z + x * w),
       0,
       s[2] * k * (x * z + y * w),
       s[2] * k * (y * z - x * w),
       s[2] * (1 - k * (x * x + y * y)),
       0,
       t[0],
       t[1],
       t[2],
       1};
  return true;
}

}  // namespace fdcg::bake::gltf
