// SPDX-License-Identifier: Apache-2.0
// The format's checksum, made for speed: it reads whole files (checksum_steps.hpp has what it is).
#include "graph/checksum.hpp"

#include <string.h>

#include "fdcg/fdcg.h"
#include "graph/checksum_steps.hpp"
#if defined(__SSE2__)
#include <immintrin.h>
#endif
// Vectors of 32 bytes where the processor that runs it has them: not on Windows, where GCC does not align them on the stack
// (its bug 54412).
#if defined(__x86_64__) && !defined(_WIN32)
#define FDCG_MAY_HAVE_AVX2 1
#else
#define FDCG_MAY_HAVE_AVX2 0
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

uint64_t folded(const uint64_t* lanes, uint64_t bytes) {
  uint64_t sum = kSeed ^ bytes;
  for (int i = 0; i < kLaneCount; ++i)
    sum = absorbed(sum, lanes[i]);
  return sum;
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
  uint64_t lane[kLaneCount];
  lanes.store(lane);
  return folded(lane, bytes);
}

#if FDCG_MAY_HAVE_AVX2

// With vectors of four words.
[[gnu::target("avx2"), gnu::always_inline]] inline __m256i four_spread(__m256i lanes, uint32_t factor) {
  return _mm256_add_epi64(lanes, _mm256_mul_epu32(lanes, _mm256_set1_epi64x(factor - 1)));
}
[[gnu::target("avx2"), gnu::always_inline]] inline __m256i four_absorbed(__m256i lanes, __m256i words) {
  const __m256i once = four_spread(_mm256_xor_si256(lanes, words), kFactor);
  return four_spread(_mm256_shuffle_epi32(once, 0xB1), kOther);
}
[[gnu::target("avx2"), gnu::always_inline]] inline __m256i four_at(const void* words) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(words));
}

constexpr int kFours = kLaneCount / 4;

// The lanes of two whole blocks at once: those of one block alone would wait for their products.
[[gnu::target("avx2"), gnu::noinline]] void sum_two_blocks(const unsigned char* data, uint64_t (*lanes)[kLaneCount]) {
  uint64_t start[kLaneCount];
  BlockLanes().store(start);
  __m256i four[2][kFours];
  memcpy(four[0], start, sizeof start);
  memcpy(four[1], start, sizeof start);
  for (uint64_t at = 0; at < kChecksumBlock; at += kStripe) {
    const unsigned char* const stripes[2] = {data + at, data + kChecksumBlock + at};
    // Of the next two blocks, in the order of memory: that is how processors fetch most at once.
    prefetch_stripe(data + 2 * (kChecksumBlock + at));
    prefetch_stripe(data + 2 * (kChecksumBlock + at) + kStripe);
#pragma GCC unroll 2
    for (int block = 0; block < 2; ++block) {
#pragma GCC unroll 4
      for (int i = 0; i < kFours; ++i)
        four[block][i] = four_absorbed(four[block][i], four_at(stripes[block] + 32 * i));
    }
  }
#pragma GCC unroll 2
  for (int block = 0; block < 2; ++block) {
#pragma GCC unroll 4
    for (int i = 0; i < kFours; ++i)
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(lanes[block] + 4 * i), four[block][i]);
  }
}

// Blocks that are folded together: the fold of one is a chain of products, each of which waits for the one before.
constexpr int kFolded = 8;

// The sums of kFolded whole blocks from their lanes.
[[gnu::target("avx2"), gnu::noinline]] void fold_blocks(const uint64_t (&lanes)[kFolded][kLaneCount],
                                                        uint64_t (&sums)[kFolded]) {
  constexpr int kVectors = kFolded / 4;
  __m256i sum[kVectors];
#pragma GCC unroll 8
  for (int v = 0; v < kVectors; ++v)
    sum[v] = _mm256_set1_epi64x(kSeed ^ kChecksumBlock);
  for (int i = 0; i < kLaneCount; i += 4) {
#pragma GCC unroll 8
    for (int v = 0; v < kVectors; ++v) {
      const uint64_t(*const block)[kLaneCount] = lanes + 4 * v;
      // Four lanes of four blocks, to a vector for each lane.
      const __m256i a = four_at(block[0] + i), b = four_at(block[1] + i), c = four_at(block[2] + i), d = four_at(block[3] + i);
      const __m256i ab0 = _mm256_unpacklo_epi64(a, b), ab1 = _mm256_unpackhi_epi64(a, b);
      const __m256i cd0 = _mm256_unpacklo_epi64(c, d), cd1 = _mm256_unpackhi_epi64(c, d);
      sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab0, cd0, 0x20));
      sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab1, cd1, 0x20));
      sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab0, cd0, 0x31));
      sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab1, cd1, 0x31));
    }
  }
#pragma GCC unroll 8
  for (int v = 0; v < kVectors; ++v)
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(sums + 4 * v), sum[v]);
}

// Of whole blocks; of an even number of them.
[[gnu::target("avx2"), gnu::noinline]] uint64_t checksum_of_pairs(const unsigned char* data, uint64_t first, uint64_t end) {
  uint64_t sum = 0;
  uint64_t lanes[kFolded][kLaneCount] = {}, sums[kFolded];
  for (uint64_t i = first; i < end; i += kFolded) {
    const uint64_t count = end - i < kFolded ? end - i : kFolded;
    for (uint64_t k = 0; k < count; k += 2)
      sum_two_blocks(data + (i + k) * kChecksumBlock, lanes + k);
    fold_blocks(lanes, sums);
    for (uint64_t k = 0; k < count; ++k)
      sum += mixed_in(sums[k], i + k);
  }
  return sum;
}

#endif

}  // namespace

uint64_t checksum_of_blocks(const unsigned char* data, uint64_t bytes, uint64_t first, uint64_t end) {
  uint64_t sum = 0, i = first;
#if FDCG_MAY_HAVE_AVX2
  if (__builtin_cpu_supports("avx2")) {
    const uint64_t whole = bytes / kChecksumBlock, last = end < whole ? end : whole;
    const uint64_t end_of_pairs = i < last ? i + (last - i) / 2 * 2 : i;
    sum += checksum_of_pairs(data, i, end_of_pairs);
    i = end_of_pairs;
  }
#endif
  for (; i < end; ++i) {
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
