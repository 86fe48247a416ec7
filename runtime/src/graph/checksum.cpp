// SPDX-License-Identifier: Apache-2.0
// The format's checksum, made for speed: it reads whole files (checksum_steps.hpp has what it is).
#include "graph/checksum.hpp"

#include <string.h>

#include "base/avx2.hpp"
#include "fdcg/fdcg.h"
#include "graph/checksum_steps.hpp"
#if defined(__SSE2__)
#include <immintrin.h>
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
template <int kLocality = 3>
void prefetch_stripe(const unsigned char* stripe) {
  __builtin_prefetch(stripe, 0, kLocality);
  __builtin_prefetch(stripe + kStripe / 2, 0, kLocality);
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

// Several blocks are summed together, their lanes in turns: those of one block alone would wait for their products. Three take
// less time than two in the cache, and more from memory, where they are a third place to read at.
struct FromMemory {
  [[maybe_unused]] static constexpr int kTogether = 2, kLocality = 3;
};
struct FromCache {
  // The nearest cache is for what is read, not for what comes.
  [[maybe_unused]] static constexpr int kTogether = 3, kLocality = 2;
};

#if FDCG_MAY_HAVE_AVX2

// With vectors of four words.
[[FDCG_AVX2, gnu::always_inline]] inline __m256i four_spread(__m256i lanes, uint32_t factor) {
  return _mm256_add_epi64(lanes, _mm256_mul_epu32(lanes, _mm256_set1_epi64x(factor - 1)));
}
[[FDCG_AVX2, gnu::always_inline]] inline __m256i four_absorbed(__m256i lanes, __m256i words) {
  const __m256i once = four_spread(_mm256_xor_si256(lanes, words), kFactor);
  return four_spread(_mm256_shuffle_epi32(once, 0xB1), kOther);
}
[[FDCG_AVX2, gnu::always_inline]] inline __m256i four_at(const void* words) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(words));
}

template <class From>
[[FDCG_AVX2, gnu::noinline]] void sum_together(const unsigned char* const* blocks, uint64_t (*lanes)[kLaneCount]) {
  constexpr int kTogether = From::kTogether, kFours = kLaneCount / 4;
  const unsigned char* const next = blocks[kTogether - 1] + kChecksumBlock;
  uint64_t start[kLaneCount];
  BlockLanes().store(start);
  __m256i four[kTogether][kFours];
#pragma GCC unroll 3
  for (auto& block : four)
    memcpy(block, start, sizeof start);
  for (uint64_t at = 0; at < kChecksumBlock; at += kStripe) {
    // Of the next blocks, in the order of memory: that is how processors fetch most at once.
#pragma GCC unroll 3
    for (int i = 0; i < kTogether; ++i)
      prefetch_stripe<From::kLocality>(next + kTogether * at + i * kStripe);
#pragma GCC unroll 3
    for (int block = 0; block < kTogether; ++block) {
#pragma GCC unroll 4
      for (int i = 0; i < kFours; ++i)
        four[block][i] = four_absorbed(four[block][i], four_at(blocks[block] + at + 32 * i));
    }
  }
#pragma GCC unroll 3
  for (int block = 0; block < kTogether; ++block) {
#pragma GCC unroll 4
    for (int i = 0; i < kFours; ++i)
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(lanes[block] + 4 * i), four[block][i]);
  }
}

// Whole blocks, of whatever sections. Their lanes are folded together: the fold of one is a chain of products, each of
// which waits for the one before.
template <class From>
class WholeBlocks {
  static constexpr int kTogether = From::kTogether, kFolded = 4 * kTogether;

 public:
  [[FDCG_AVX2]] void add(const unsigned char* block, uint64_t index, uint64_t* sum) {
    blocks_[count_] = block;
    indices_[count_] = index;
    sums_[count_] = sum;
    if (++count_ % kTogether == 0) sum_last();
    if (count_ == kFolded) fold_all();
  }
  // After the last.
  [[FDCG_AVX2]] void finish() {
    if (count_ == 0) return;
    const int added = count_;
    for (; count_ % kTogether != 0; ++count_)  // what fills a group up is summed in vain
      blocks_[count_] = blocks_[added - 1];
    if (count_ != added) sum_last();
    count_ = added;
    fold_all();
  }

 private:
  [[FDCG_AVX2]] void sum_last() { sum_together<From>(blocks_ + count_ - kTogether, lanes_ + count_ - kTogether); }

  [[FDCG_AVX2, gnu::noinline]] void fold_all() {
    uint64_t folded[kFolded];
    fold(lanes_, folded);
    for (int i = 0; i < count_; ++i)
      *sums_[i] += mixed_in(folded[i], indices_[i]);
    count_ = 0;
  }

  [[FDCG_AVX2, gnu::noinline]] static void fold(const uint64_t (&lanes)[kFolded][kLaneCount], uint64_t (&folded)[kFolded]) {
    constexpr int kVectors = kFolded / 4;
    __m256i sum[kVectors];
#pragma GCC unroll 3
    for (auto& four : sum)
      four = _mm256_set1_epi64x(kSeed ^ kChecksumBlock);
    for (int i = 0; i < kLaneCount; i += 4) {
#pragma GCC unroll 3
      for (int v = 0; v < kVectors; ++v) {
        const uint64_t(*const block)[kLaneCount] = lanes + 4 * v;
        // Four lanes of four blocks, to a vector for each lane.
        const __m256i a = four_at(block[0] + i), b = four_at(block[1] + i), c = four_at(block[2] + i),
                      d = four_at(block[3] + i);
        const __m256i ab0 = _mm256_unpacklo_epi64(a, b), ab1 = _mm256_unpackhi_epi64(a, b);
        const __m256i cd0 = _mm256_unpacklo_epi64(c, d), cd1 = _mm256_unpackhi_epi64(c, d);
        sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab0, cd0, 0x20));
        sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab1, cd1, 0x20));
        sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab0, cd0, 0x31));
        sum[v] = four_absorbed(sum[v], _mm256_permute2x128_si256(ab1, cd1, 0x31));
      }
    }
#pragma GCC unroll 3
    for (int v = 0; v < kVectors; ++v)
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(folded + 4 * v), sum[v]);
  }

  const unsigned char* blocks_[kFolded];
  uint64_t indices_[kFolded];
  uint64_t* sums_[kFolded];
  int count_ = 0;
  uint64_t lanes_[kFolded][kLaneCount] = {};
};

#endif

template <class From>
void add_sums(const BlockRange* ranges, uint32_t count) {
#if FDCG_MAY_HAVE_AVX2
  const bool is_wide = has_avx2();
  WholeBlocks<From> blocks;
#endif
  for (const BlockRange* range = ranges; range < ranges + count; ++range) {
    uint64_t i = range->first;
#if FDCG_MAY_HAVE_AVX2
    const uint64_t whole = range->bytes / kChecksumBlock;
    for (; is_wide && i < range->end && i < whole; ++i)
      blocks.add(range->data + i * kChecksumBlock, i, range->sum);
#endif
    for (; i < range->end; ++i) {
      const uint64_t at = i * kChecksumBlock, left = range->bytes - at;
      *range->sum += mixed_in(block_sum(range->data + at, left < kChecksumBlock ? left : kChecksumBlock), i);
    }
  }
#if FDCG_MAY_HAVE_AVX2
  if (is_wide) blocks.finish();
#endif
}

}  // namespace

void add_checksums(const BlockRange* ranges, uint32_t count) {
  add_sums<FromCache>(ranges, count);
}

uint64_t checksum_of_blocks(const unsigned char* data, uint64_t bytes, uint64_t first, uint64_t end) {
  uint64_t sum = 0;
  const BlockRange range = {data, bytes, first, end, &sum};
  add_sums<FromMemory>(&range, 1);
  return sum;
}

}  // namespace fdcg

extern "C" uint64_t fdcg_checksum(const void* data, uint64_t bytes) {
  const uint64_t blocks = fdcg::checksum_blocks(bytes);
  return fdcg::checksum_start(bytes) + fdcg::checksum_of_blocks(static_cast<const unsigned char*>(data), bytes, 0, blocks);
}
