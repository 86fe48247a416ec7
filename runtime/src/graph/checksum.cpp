// SPDX-License-Identifier: Apache-2.0
// The format's checksum, made for speed: it reads whole files (checksum_steps.hpp has what it is).
#include "graph/checksum.hpp"

#include <string.h>

#include "fdcg/fdcg.h"
#include "graph/checksum_steps.hpp"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fdcg {
namespace {

#if defined(__SSE2__)

[[gnu::always_inline]] inline __m128i both_spread(__m128i lanes, uint32_t factor) {
  return _mm_add_epi64(lanes, _mm_mul_epu32(lanes, _mm_set1_epi64x(factor - 1)));
}

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
#pragma GCC unroll 8
    for (int i = 0; i < kPairs; ++i) {
      const __m128i words = _mm_loadu_si128(reinterpret_cast<const __m128i*>(stripe + 16 * i));
      pair[i] = both_spread(_mm_shuffle_epi32(both_spread(_mm_xor_si128(pair[i], words), kFactor), 0xB1), kOther);
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

}  // namespace

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
