// SPDX-License-Identifier: Apache-2.0
// The format's checksum: eight 64-bit lanes, each a chain of steps that can be undone (xor with a word, times an odd number,
// rotation), folded by steps that can be undone in each lane. So two inputs of one length that differ inside a single word
// always differ in the result; elsewhere they agree by chance once in 2^64. It detects damage, not deliberate changes.
#include <string.h>

#include "fdcg/fdcg.h"

namespace {

constexpr int kChecksumLanes = 8;
constexpr uint64_t kMultiplier = 0x9E3779B97F4A7C15u;  // odd, bits well mixed: 2^64 over the golden ratio
constexpr uint64_t kSeed = 0x46444347'00000001u;       // "FDCG", version of the checksum

uint64_t rotate(uint64_t x, int bits) {
  return (x << bits) | (x >> (64 - bits));
}

uint64_t load_word(const unsigned char* bytes) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the format is little-endian and read in place");
  uint64_t word;
  memcpy(&word, bytes, sizeof word);
  return word;
}

void absorb_block(uint64_t* lanes, const unsigned char* block) {
  for (int i = 0; i < kChecksumLanes; ++i)
    lanes[i] = rotate((lanes[i] ^ load_word(block + 8 * i)) * kMultiplier, 29);
}

}  // namespace

extern "C" uint64_t fdcg_checksum(const void* data, uint64_t bytes) {
  constexpr uint64_t kBlock = 8 * kChecksumLanes;
  const auto* at = static_cast<const unsigned char*>(data);
  uint64_t lanes[kChecksumLanes];
  for (int i = 0; i < kChecksumLanes; ++i)
    lanes[i] = kSeed + static_cast<uint64_t>(i);
  const uint64_t whole = bytes / kBlock;
  for (uint64_t i = 0; i < whole; ++i)
    absorb_block(lanes, at + kBlock * i);
  if (const uint64_t rest = bytes % kBlock) {
    unsigned char block[kBlock] = {};
    memcpy(block, at + kBlock * whole, rest);
    absorb_block(lanes, block);
  }
  uint64_t sum = kSeed ^ (bytes * kMultiplier);
  for (uint64_t lane : lanes) {
    sum = (sum ^ lane) * kMultiplier;
    sum ^= sum >> 32;
  }
  return sum;
}
