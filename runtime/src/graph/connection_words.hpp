// SPDX-License-Identifier: Apache-2.0
// Connections' records as words: what verification asks of all of them, in as few operations as may be.
#pragma once

#include <string.h>

#include "base/lanes.hpp"
#include "fdcg/format.h"

namespace fdcg {

// A connection's record as one word: node 0, side of node 0, side of node 1, type, flatness.
inline constexpr int kSide1At = 40, kTypeAt = 48, kFlatnessAt = 56;
inline constexpr uint64_t kByte = 0xFF;

static_assert(sizeof(fdcg_connection) == 8 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

// As many of them as the processor takes at once.
#if FDCG_HAS_VECTORS
inline constexpr uint64_t kWords = 2;
using Words = uint64_t __attribute__((vector_size(16)));
inline uint64_t any_of(Words words) {
  return words[0] | words[1];
}
inline uint64_t sum_of(Words words) {
  return words[0] + words[1];
}
#else
inline constexpr uint64_t kWords = 1;
using Words = uint64_t;
inline uint64_t any_of(Words words) {
  return words;
}
inline uint64_t sum_of(Words words) {
  return words;
}
#endif

// A record of the next chunk, which memory sends while this one's are judged. Inlined by force: GCC drops calls of a function
// that does nothing else.
[[gnu::always_inline]] inline void prefetch(const void* record) {
  __builtin_prefetch(record, 0, 2);
}

struct ConnectionWords {
  uint64_t any;       // bits that are in any
  uint64_t pairs;     // bits that are in one together with the next higher bit
  uint64_t types[4];  // how many are of each; right where no type is larger than 3
};

// Sums of types, of their upper bits, and of both bits, in each number of `Words`: zeros add nothing.
template <class Words>
struct ConnectionSums {
  Words any = {}, pairs = {}, types = {}, uppers = {}, boundaries = {};

  [[gnu::always_inline]] void look_at(const Words& words) {
    const Words pair = words & words >> 1, type = words >> kTypeAt & 3;
    any |= words;
    pairs |= pair;
    types += type;
    uppers += type >> 1;
    boundaries += pair >> kTypeAt & 1;
  }
};
inline ConnectionWords connection_words(uint64_t any, uint64_t pairs, uint64_t types, uint64_t uppers, uint64_t boundaries,
                                        uint64_t count) {
  const uint64_t of3 = boundaries, of2 = uppers - of3, of1 = types - 2 * of2 - 3 * of3;
  return {any, pairs, {count - of1 - of2 - of3, of1, of2, of3}};
}

// Prefetches as many that follow.
inline ConnectionWords look_at_words(const fdcg_connection* connections, uint64_t count) {
  ConnectionSums<Words> sums;
  constexpr uint64_t kPerLine = 8;  // connections in a cache line of 64 bytes
  uint64_t i = 0;
  for (; i + kWords <= count; i += kWords) {
    Words words;
    memcpy(&words, connections + i, sizeof words);
    if (i % kPerLine < kWords) prefetch(connections + i + count);
    sums.look_at(words);
  }
  if (i < count) {
    Words words = {};
    memcpy(&words, connections + i, sizeof(fdcg_connection));
    sums.look_at(words);
  }
  return connection_words(any_of(sums.any), any_of(sums.pairs), sum_of(sums.types), sum_of(sums.uppers),
                          sum_of(sums.boundaries), count);
}

}  // namespace fdcg
