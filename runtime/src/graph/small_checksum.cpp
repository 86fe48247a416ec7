// SPDX-License-Identifier: Apache-2.0
// The format's checksum of what is shorter than a block, made small.
#include <string.h>

#include "graph/checksum.hpp"
#include "graph/checksum_steps.hpp"

namespace fdcg {

uint64_t checksum_start(uint64_t bytes) {
  return kSeed + bytes * kMultiplier;
}

uint64_t small_checksum(const void* data, uint32_t bytes) {
  const uint32_t words = bytes / sizeof(uint64_t);
  uint64_t lanes[kLaneCount], sum = kSeed ^ bytes;
  for (uint32_t i = 0; i < kLaneCount; ++i)
    lanes[i] = kSeed + i * kMultiplier;
  for (uint32_t stripe = 0; stripe < words; stripe += kLaneCount) {
    for (uint32_t i = 0; i < kLaneCount; ++i) {
      uint64_t word = 0;  // past the end
      if (stripe + i < words) memcpy(&word, static_cast<const unsigned char*>(data) + (stripe + i) * sizeof word, sizeof word);
      lanes[i] = absorbed(lanes[i], word);
    }
  }
  for (const uint64_t lane : lanes)
    sum = absorbed(sum, lane);
  return checksum_start(bytes) + mixed_in(sum, 0);
}

}  // namespace fdcg
