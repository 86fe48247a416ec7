// SPDX-License-Identifier: Apache-2.0
// The format's checksum in pieces (schemas/fdcg-v1.md): blocks that may be summed in any order, by several threads.
#pragma once

#include <stdint.h>

namespace fdcg {

inline constexpr uint64_t kChecksumBlock = 4096;  // bytes; the last block of a section may be shorter

constexpr uint64_t checksum_blocks(uint64_t bytes) {
  return bytes / kChecksumBlock + (bytes % kChecksumBlock != 0 ? 1 : 0);
}

// The checksum of `bytes` bytes is checksum_start(bytes) plus checksum_of_blocks of all their blocks, modulo 2^64.
uint64_t checksum_start(uint64_t bytes);
// The sum over blocks first to end - 1 of the `bytes` bytes at `data`.
uint64_t checksum_of_blocks(const unsigned char* data, uint64_t bytes, uint64_t first, uint64_t end);

// The same, added to *sum; of several ranges at once, which takes less time than one after another. For what has been
// prefetched: from memory it takes more.
struct BlockRange {
  const unsigned char* data;
  uint64_t bytes, first, end;
  uint64_t* sum;
};
void add_checksums(const BlockRange* ranges, uint32_t count);

// The checksum of a header or a table, whole words and at most a block, in as little code as may be: opening a trusted graph
// needs no other.
uint64_t small_checksum(const void* data, uint32_t bytes);

}  // namespace fdcg
