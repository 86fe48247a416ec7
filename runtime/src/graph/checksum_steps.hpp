// SPDX-License-Identifier: Apache-2.0
// The format's checksum: blocks of 4,096 bytes, each sixteen 64-bit lanes wide, each lane a chain of steps that can be undone
// (xor with a word; the lower half times an odd number, carried into the upper half; the halves exchanged; the same by
// another), folded by the same steps. A block's sum goes through steps that can be undone too before the sums are added up. So
// two inputs of one length that differ inside a single word always differ in the result. Each half of a word is multiplied
// before the next word comes: a half that stood unmixed there would cancel with an equal change of that word. It detects
// damage, not deliberate changes.
//
// Blocks are apart so that threads can share a section; products of 32 bits are what SSE2 has, two words at once.
#pragma once

#include <stdint.h>

namespace fdcg {

constexpr int kLaneCount = 16;
constexpr uint64_t kStripe = 8 * kLaneCount;
constexpr uint32_t kFactor = 0x9E3779B1u;              // odd, bits well mixed: a prime near 2^32 over the golden ratio
constexpr uint32_t kOther = 0x85EBCA77u;               // another prime: by one alone what a step adds the next could take back
constexpr uint64_t kMultiplier = 0x9E3779B97F4A7C15u;  // odd, bits well mixed: 2^64 over the golden ratio
constexpr uint64_t kSeed = 0x46444347'00000003u;       // "FDCG", version of the checksum

// The lower half times an odd number, as a product of 64 bits, and the upper half added.
inline uint64_t spread(uint64_t lane, uint32_t factor) {
  return lane + (lane & 0xFFFFFFFFu) * (factor - 1);
}

inline uint64_t absorbed(uint64_t lane, uint64_t word) {
  const uint64_t once = spread(lane ^ word, kFactor);
  return spread(once << 32 | once >> 32, kOther);
}

// What a block adds to the sum.
inline uint64_t mixed_in(uint64_t sum, uint64_t index) {
  uint64_t mixed = (sum + index * kMultiplier) * kMultiplier;
  mixed ^= mixed >> 32;
  return mixed * kMultiplier;
}

}  // namespace fdcg
