// SPDX-License-Identifier: Apache-2.0
// The format's checksum: blocks of 4,096 bytes, each sixteen 64-bit lanes wide, each lane a chain of steps that can be undone
// (xor with a word; the lower half times an odd number, the halves exchanged, the upper half mixed in), folded by the same
// steps. A block's sum goes through steps that can be undone too before the sums are added up. So two inputs of one length that
// differ inside a single word always differ in the result; elsewhere they agree by chance once in 2^64. It detects damage,
// not deliberate changes.
//
// Blocks are apart so that threads can share a section; one product of 32 bits a word is what SSE2 has, two words at once.
#include "graph/checksum.hpp"

#include <string.h>

#include "fdcg/fdcg.h"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fdcg {
namespace {

constexpr int kLaneCount = 16;
constexpr uint64_t kStripe = 8 * kLaneCount;
constexpr uint32_t kFactor = 0x9E3779B1u;              // odd, bits well mixed: a prime near 2^32 over the golden ratio
constexpr uint64_t kMultiplier = 0x9E3779B97F4A7C15u;  // odd, bits well mixed: 2^64 over the golden ratio
constexpr uint64_t kSeed = 0x46444347'00000002u;       // "FDCG", version of the checksum

uint64_t absorbed(uint64_t lane, uint64_t word) {
  const uint64_t mixed = lane ^ word, product = (mixed & 0xFFFFFFFFu) * kFactor;
  return (product << 32 | product >> 32) ^ mixed >> 32;
}

#if defined(__SSE2__)

struct BlockLanes {
  static constexpr int kPairs = kLaneCount / 2;
  __m128i pair[kPairs];

  BlockLanes() {
    for (int i = 0; i < kPairs; ++i) {
      const uint64_t first = kSeed + 2 * static_cast<uint64_t>(i) * kMultiplier;
      pair[i] = _mm_set_epi64x(static_cast<int64_t>(first + kMultiplier), static_cast<int64_t>(first));
    }
  }
  [[gnu::always_inline]] void absorb(const unsigned char* stripe) {
    const __m128i factor = _mm_set1_epi64x(kFactor);
#pragma GCC unroll 8
    for (int i = 0; i < kPairs; ++i) {
      const __m128i mixed = _mm_xor_si128(pair[i], _mm_loadu_si128(reinterpret_cast<const __m128i*>(stripe + 16 * i)));
      const __m128i product = _mm_shuffle_epi32(_mm_mul_epu32(mixed, factor), 0xB1);
      pair[i] = _mm_xor_si128(product, _mm_srli_epi64(mixed, 32));
    }
  }
  void store(uint64_t (&lanes)[kLaneCount]) const {
    memcpy(lanes, pair, sizeof lanes);
  }
};

#else

struct BlockLanes {
  uint64_t lane[kLaneCount];

  BlockLanes() {
    for (int i = 0; i < kLaneCount; ++i)
      lane[i] = kSeed + static_cast<uint64_t>(i) * kMultiplier;
  }
  void absorb(const unsigned char* stripe) {
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the format is little-endian and read in place");
    for (int i = 0; i < kLaneCount; ++i) {
      uint64_t word;
      memcpy(&word, stripe + 8 * i, sizeof word);
      lane[i] = absorbed(lane[i], word);
    }
  }
  void store(uint64_t (&lanes)[kLaneCount]) const { memcpy(lanes, lane, sizeof lanes); }
};

#endif

// Processors do not prefetch past the end of a page, and a block is a page of most: without this the sum waits at each.
constexpr uint64_t kAhead = 4096;
void prefetch_stripe(const unsigned char* stripe) {
  __builtin_prefetch(stripe);
  __builtin_prefetch(stripe + kStripe / 2);
}

uint64_t block_sum(const unsigned char* data, uint64_t bytes) {
  BlockLanes lanes;
  unsigned char rest[kStripe];
  for (uint64_t left = bytes; left != 0;) {
    const unsigned char* stripe = data;
    if (left < kStripe) {
      memset(rest, 0, sizeof rest);
      memcpy(rest, data, left);
      stripe = rest;
    }
    prefetch_stripe(data + kAhead);
    lanes.absorb(stripe);
    data += kStripe;
    left = left < kStripe ? 0 : left - kStripe;
  }
  uint64_t lane[kLaneCount], sum = kSeed ^ bytes;
  lanes.store(lane);
  for (const uint64_t word : lane)
    sum = absorbed(sum, word);
  return sum;
}

uint64_t mixed_in(uint64_t sum, uint64_t index) {
  uint64_t mixed = (sum + index * kMultiplier) * kMultiplier;
  mixed ^= mixed >> 32;
  return mixed * kMultiplier;
}

}  // namespace

uint64_t checksum_start(uint64_t bytes) {
  return kSeed + bytes * kMultiplier;
}

uint64_t checksum_of_blocks(const unsigned char* data, uint64_t bytes, uint64_t first, uint64_t end) {
  uint64_t sum = 0;
  for (uint64_t i = first; i < end; ++i) {
    const uint64_t at = i * kChecksumBlock, left = bytes - at;
    sum += mixed_in(block_sum(data + at, left < kChecksumBlock ? left : kChecksumBlock), i);
  }
  return sum;
}

}  // namespace fdcg

extern "C" uint64_t fdcg_checksum(const void* data, uint64_t bytes) {
  const uint64_t blocks = fdcg::checksum_blocks(bytes);
  return fdcg::checksum_start(bytes) + fdcg::checksum_of_blocks(static_cast<const unsigned char*>(data), bytes, 0, blocks);
}
