// SPDX-License-Identifier: Apache-2.0
#include "import/placing.hpp"

#include <algorithm>
#include <cmath>

#include "base/quantised.hpp"

namespace fdcg::bake {

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t k = 0; k < 4; ++k)
        result[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return result;
}

Vec3 applied(const Matrix& m, const Vec3& p) {
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

Matrix turned_about(const Vec3& axis, double cosine, double sine) {
  const auto [x, y, z] = axis;
  const double c = cosine, s = sine, k = 1 - c;
  return {c + k * x * x,
          k * x * y + s * z,
          k * x * z - s * y,
          0,
          k * x * y - s * z,
          c + k * y * y,
          k * y * z + s * x,
          0,
          k * x * z + s * y,
          k * y * z - s * x,
          c + k * z * z,
          0,
          0,
          0,
          0,
          1};
}

bool is_mirrored(const Matrix& m) {
  return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) + m[8] * (m[1] * m[6] - m[5] * m[2]) < 0;
}

bool is_finite(const Matrix& m) {
  return std::all_of(m.begin(), m.end(), [](double c) { return std::isfinite(c); });
}

void Rounding::note(const Grain& grain, const std::array<double, 3>& largest, const Matrix* world) {
  constexpr double kSum = 0x1p-51;  // of three products and three sums
  if (world == nullptr) half_step_ = std::max(half_step_, grain.half_step);
  is_moved_ = is_moved_ || world != nullptr;
  const Matrix& m = world != nullptr ? *world : kIdentity;
  for (std::size_t row = 0; row < 3; ++row) {
    double off = 0, size = std::fabs(m[12 + row]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double factor = std::fabs(m[4 * k + row]);
      off += factor * std::max(grain.relative * largest[k], grain.half_step);
      size += factor * largest[k];
    }
    bound_ = std::max(bound_, off + (world != nullptr ? kSum * size : 0));
  }
}

void Rounding::finish(PolygonSoup& soup) const {
  if (is_moved_) soup.relative_quantum = 0x1p-53;
  const double bound = is_moved_ ? bound_ : half_step_;
  if (bound > 0) soup.absolute_quantum = at_most_a_share(bound, soup.points);
}

}  // namespace fdcg::bake
