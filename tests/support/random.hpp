// SPDX-License-Identifier: Apache-2.0
// Random numbers that are the same on every machine and standard library: tests must be repeatable from their seed.
#pragma once

#include <cmath>
#include <cstdint>

#include "fdcg/bake.hpp"

namespace fdcg::test {

// SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  // Uniform in [0, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  // Uniform in 0 .. count - 1; count > 0.
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>((bits() >> 32) * count >> 32); }
  bool chance(double probability) { return unit() < probability; }

  // Uniform on the unit sphere.
  bake::Vec3 direction() {
    for (;;) {
      const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
      const double length2 = x * x + y * y + z * z;
      if (length2 > 1e-4 && length2 <= 1) {
        const double scale = 1 / std::sqrt(length2);
        return {x * scale, y * scale, z * scale};
      }
    }
  }

 private:
  std::uint64_t state_;
};

// A fixed number in [0, 1) for each (seed, index).
inline double hashed_unit(std::uint64_t seed, std::uint64_t index) {
  return Random(seed * 0xD6E8FEB86659FD93u + index * 0xA0761D6478BD642Fu).unit();
}

}  // namespace fdcg::test
