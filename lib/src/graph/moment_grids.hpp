// SPDX-License-Identifier: Apache-2.0
// Coordinates as whole numbers of few bits, for moment_sums.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "base/vec3.hpp"
#include "exact/limbs.hpp"

namespace fdcg::bake {

// The grid, the bit above the highest one of any coordinate, and the corner of the bounding box.
struct BitExtent {
  int low_bit = std::numeric_limits<int>::max(), high_bit = std::numeric_limits<int>::min();
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};

  void add(double x) {
    constexpr int kBias = 1075;  // of an exponent when the mantissa counts as a whole number
    if (x == 0) return;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const auto stored = static_cast<int>(bits >> 52 & 0x7FFu);
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
    const std::uint64_t mantissa = stored == 0 ? fraction : fraction | std::uint64_t{1} << 52;
    const int exponent = std::max(stored, 1) - kBias;
    low_bit = std::min(low_bit, exponent + std::countr_zero(mantissa));
    high_bit = std::max(high_bit, exponent + static_cast<int>(std::bit_width(mantissa)));
  }
  void add(const Vec3& p) {
    add(p.x);
    add(p.y);
    add(p.z);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  }
  void add(const BitExtent& other) {
    low_bit = std::min(low_bit, other.low_bit);
    high_bit = std::max(high_bit, other.high_bit);
    low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
  }
};

// Grids of which all coordinates are within 2^60 and 2^124 units, and one that has them all; the point that coordinates are
// measured from, on the first.
struct Grids {
  int narrow = 0, wide = 0, all = 0;
  std::array<std::int64_t, 3> from{};  // in units of `narrow`; none above any coordinate
};

inline Grids grids_of(const BitExtent& extent) {
  Grids grids;
  grids.narrow = extent.high_bit - 60;
  grids.wide = extent.high_bit - 124;
  grids.all = std::min(extent.low_bit, grids.wide);
  for (int k = 0; k < 3; ++k)
    grids.from[static_cast<std::size_t>(k)] =
        static_cast<std::int64_t>(std::floor(std::ldexp(component(extent.low, k), -grids.narrow)));
  return grids;
}

// A corner as integers on one of the grids, measured from the corner of the bounding box and so never negative: then only a
// triangle's determinant has a sign, and it decides which of two sums the triangle adds to. `Signed` has 64 N bits; coordinates
// of at most 64 N - 4 are below 2^b here, b = 64 N - 3.
template <class Signed>
class Reader {
 public:
  Reader(const Grids& grids, int grid) {
    constexpr int kLargestExponent = 1000;  // the scale is a double
    is_in_range_ = std::abs(grid) <= kLargestExponent;
    scale_ = is_in_range_ ? std::ldexp(1.0, -grid) : 0;
    for (std::size_t k = 0; k < 3; ++k)
      from_[k] = Signed{grids.from[k]} * (Signed{1} << (grids.narrow - grid));
  }
  [[nodiscard]] bool is_in_range() const { return is_in_range_; }
  // `is_on_grid` becomes false where the point is not.
  [[nodiscard]] std::array<Signed, 3> read(const Vec3& p, bool& is_on_grid) const {
    return {whole(p.x, is_on_grid) - from_[0], whole(p.y, is_on_grid) - from_[1], whole(p.z, is_on_grid) - from_[2]};
  }

 private:
  // x / 2^grid. With 128 bits in two steps, each of fewer bits than an int64_t has.
  [[nodiscard]] Signed whole(double x, bool& is_on_grid) const {
    const double scaled = x * scale_;
    if constexpr (sizeof(Signed) == sizeof(std::int64_t)) {
      const auto value = static_cast<std::int64_t>(scaled);
      is_on_grid &= static_cast<double>(value) == scaled;
      return value;
    } else {
      constexpr int kStepBits = 62;
      constexpr double kStep = std::uint64_t{1} << kStepBits;
      const auto high = static_cast<std::int64_t>(scaled * (1 / kStep));
      const double rest = scaled - static_cast<double>(high) * kStep;  // exact
      const auto low = static_cast<std::int64_t>(rest);
      is_on_grid &= static_cast<double>(low) == rest;
      return Signed{high} * (Signed{1} << kStepBits) + low;
    }
  }

  double scale_ = 0;
  bool is_in_range_ = false;
  std::array<Signed, 3> from_{};
};

}  // namespace fdcg::bake
