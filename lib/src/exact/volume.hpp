// SPDX-License-Identifier: Apache-2.0
// The exact sign of a sum of products of three doubles, for the volume that a closed surface encloses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A fixed-point number wide enough for every product of three doubles, from 2^-3222 up, and for 2^60 of them. No rounding.
class ExactSum {
 public:
  // Adds or subtracts a * b * c. Finite factors.
  void add_product(double a, double b, double c, bool negative);
  // Adds the determinant |a b c|: six times the signed volume of the tetrahedron over the origin.
  void add_determinant(const Vec3& a, const Vec3& b, const Vec3& c);
  [[nodiscard]] int sign();

 private:
  static constexpr int kLowestExponent = -3 * 1074;  // of the smallest subnormal, cubed
  // 3 * 1024 bits above the point, 3 * 1074 below, 64 for the number of terms; 32 bits a limb, the rest of it is for carries.
  static constexpr std::size_t kLimbs = (3 * 1024 + 3 * 1074 + 64) / 32 + 2;
  void carry();

  std::array<std::int64_t, kLimbs> limbs_{};
  std::uint32_t pending_ = 0;  // products added since the last carry
};

}  // namespace fdcg::bake
