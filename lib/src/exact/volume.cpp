// SPDX-License-Identifier: Apache-2.0
#include "exact/volume.hpp"

#include <cmath>

namespace fdcg::bake {
namespace {

__extension__ using uint128 = unsigned __int128;

// |x| = mantissa * 2^exponent with a mantissa of at most 53 bits.
struct Parts {
  std::uint64_t mantissa;
  int exponent;
};

Parts parts(double x) {
  int exponent = 0;
  const double fraction = std::frexp(std::abs(x), &exponent);  // [0.5, 1), of a subnormal too
  Parts p{static_cast<std::uint64_t>(std::ldexp(fraction, 53)), exponent - 53};
  if (p.exponent < -1074) {  // a subnormal: the bits that frexp appended are zeros
    p.mantissa >>= -1074 - p.exponent;
    p.exponent = -1074;
  }
  return p;
}

}  // namespace

void ExactSum::add_product(double a, double b, double c, bool negative) {
  if (a == 0 || b == 0 || c == 0) return;
  if (std::signbit(a) != std::signbit(b)) negative = !negative;
  if (std::signbit(c)) negative = !negative;
  const Parts pa = parts(a), pb = parts(b), pc = parts(c);
  const auto position = static_cast<unsigned>(pa.exponent + pb.exponent + pc.exponent - kLowestExponent);

  // The product has at most 159 bits: each step keeps the low 64 and carries the rest.
  const uint128 ab = uint128{pa.mantissa} * pb.mantissa;
  const uint128 low = uint128{static_cast<std::uint64_t>(ab)} * pc.mantissa;
  const uint128 high = (ab >> 64) * pc.mantissa + (low >> 64);
  std::array<std::uint32_t, 6> words{};
  const std::array<std::uint64_t, 3> limbs64{static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high),
                                             static_cast<std::uint64_t>(high >> 64)};
  for (std::size_t i = 0; i < 6; ++i)
    words[i] = static_cast<std::uint32_t>(limbs64[i / 2] >> (i % 2 * 32));

  const std::size_t limb = position / 32;
  const unsigned shift = position % 32;
  std::uint64_t carried = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::uint64_t shifted = (std::uint64_t{words[i]} << shift) + carried;
    const auto part = static_cast<std::int64_t>(shifted & 0xFFFFFFFFU);
    limbs_[limb + i] += negative ? -part : part;
    carried = shifted >> 32;
  }
  // 159 + 31 bits fit in six words: no carry remains.
  if (++pending_ == 1U << 30) carry();
}

void ExactSum::add_determinant(const Vec3& a, const Vec3& b, const Vec3& c) {
  add_product(a.x, b.y, c.z, false);
  add_product(a.x, b.z, c.y, true);
  add_product(a.y, b.z, c.x, false);
  add_product(a.y, b.x, c.z, true);
  add_product(a.z, b.x, c.y, false);
  add_product(a.z, b.y, c.x, true);
}

void ExactSum::carry() {
  for (std::size_t i = 0; i + 1 < kLimbs; ++i) {
    const std::int64_t up = limbs_[i] >> 32;  // rounds down: what remains is in [0, 2^32)
    limbs_[i] -= up * (std::int64_t{1} << 32);
    limbs_[i + 1] += up;
  }
  pending_ = 0;
}

int ExactSum::sign() {
  carry();
  if (limbs_[kLimbs - 1] != 0) return limbs_[kLimbs - 1] < 0 ? -1 : 1;
  for (const std::int64_t limb : limbs_) {
    if (limb != 0) return 1;  // after carrying only the top limb can be negative
  }
  return 0;
}

}  // namespace fdcg::bake
