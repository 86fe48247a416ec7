// SPDX-License-Identifier: Apache-2.0
// The Hilbert curve in three dimensions (after Skilling, "Programming the Hilbert curve", 2004).
#pragma once

#include <array>
#include <cstdint>

namespace fdcg::bake {

inline constexpr unsigned kHilbertBits = 14;  // an axis: cells of 1/16384 of the object

// How far along the curve the cell is; each coordinate below 2^kHilbertBits. Neighbouring positions are neighbouring cells.
[[nodiscard]] inline std::uint64_t hilbert_position(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1u << (kHilbertBits - 1); q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (unsigned i = 0; i < 3; ++i) {
      const std::uint32_t is_set = 0u - ((x[i] & q) != 0);
      const std::uint32_t exchange = (x[0] ^ x[i]) & below & ~is_set;
      x[0] ^= (below & is_set) | exchange;
      x[i] ^= exchange;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t gray = 0;
  for (std::uint32_t q = 1u << (kHilbertBits - 1); q > 1; q >>= 1)
    gray ^= (q - 1) & (0u - ((x[2] & q) != 0));
  std::uint64_t position = 0;
  for (unsigned bit = kHilbertBits; bit-- > 0;) {
    for (unsigned i = 0; i < 3; ++i)
      position = position << 1 | (((x[i] ^ gray) >> bit) & 1u);
  }
  return position;
}

}  // namespace fdcg::bake
