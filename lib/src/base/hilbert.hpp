// SPDX-License-Identifier: Apache-2.0
// The Hilbert curve in three dimensions (after Skilling, "Programming the Hilbert curve", 2004), as a finite-state machine that
// reads one bit of each coordinate at a time.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace fdcg::bake {

namespace hilbert {

// Orientation of the current subcube: its axis i is axis `axis[i]` of the whole cube, mirrored where `is_flipped[i]`; and
// whether the curve traverses it backwards.
struct State {
  std::array<unsigned, 3> axis{0, 1, 2};
  std::array<unsigned, 3> is_flipped{0, 0, 0};
  unsigned is_backwards = 0;

  [[nodiscard]] constexpr unsigned number() const {
    return ((axis[0] * 3 + axis[1]) * 8 + is_flipped[0] * 4 + is_flipped[1] * 2 + is_flipped[2]) * 2 + is_backwards;
  }
};

struct Step {
  std::uint8_t digit = 0;  // index of the octant along the curve
  std::uint8_t next = 0;   // state inside that octant
};

// The transition from a state for one bit of each coordinate of the whole cube (x << 2 | y << 1 | z).
constexpr std::pair<unsigned, State> step(State state, unsigned bits) {
  std::array<unsigned, 3> y{};
  for (unsigned i = 0; i < 3; ++i)
    y[i] = (bits >> (2 - state.axis[i]) & 1u) ^ state.is_flipped[i];
  for (unsigned i = 0; i < 3; ++i) {
    if (y[i] != 0) {
      state.is_flipped[0] ^= 1u;
    } else {
      std::swap(state.axis[0], state.axis[i]);
      std::swap(state.is_flipped[0], state.is_flipped[i]);
    }
  }
  const unsigned g0 = y[0], g1 = y[1] ^ g0, g2 = y[2] ^ g1, t = state.is_backwards;
  state.is_backwards ^= g2;
  return {(g0 ^ t) << 2 | (g1 ^ t) << 1 | (g2 ^ t), state};
}

inline constexpr unsigned kStates = 9 * 8 * 2;  // a few of them never reached

constexpr std::array<Step, kStates * 8> make_steps() {
  std::array<Step, kStates * 8> steps{};
  for (unsigned a = 0; a < 3; ++a) {
    for (unsigned b = 0; b < 3; ++b) {
      for (unsigned rest = 0; rest < 16 && a != b; ++rest) {
        const State state{{a, b, 3 - a - b}, {rest >> 3 & 1u, rest >> 2 & 1u, rest >> 1 & 1u}, rest & 1u};
        for (unsigned bits = 0; bits < 8; ++bits) {
          const auto [digit, next] = step(state, bits);
          steps[state.number() * 8 + bits] = {static_cast<std::uint8_t>(digit), static_cast<std::uint8_t>(next.number())};
        }
      }
    }
  }
  return steps;
}

inline constexpr std::array<Step, kStates* 8> kSteps = make_steps();

}  // namespace hilbert

// The cell's position along the curve through 2^bits cells per axis. Each coordinate is below 2^bits; bits is at most 21. Cells
// at consecutive positions are neighbours.
[[nodiscard]] inline std::uint64_t hilbert_position(const std::array<std::uint32_t, 3>& x, unsigned bits) {
  std::uint64_t position = 0;
  unsigned state = hilbert::State{}.number();
  for (unsigned bit = bits; bit-- > 0;) {
    const unsigned here = (x[0] >> bit & 1u) << 2 | (x[1] >> bit & 1u) << 1 | (x[2] >> bit & 1u);
    const hilbert::Step& step = hilbert::kSteps[state * 8 + here];
    position = position << 3 | step.digit;
    state = step.next;
  }
  return position;
}

}  // namespace fdcg::bake
