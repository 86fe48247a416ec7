// SPDX-License-Identifier: Apache-2.0
// The format's checksum, made small: byte by byte.
#include "graph/checksum.hpp"
#include "graph/checksum_steps.hpp"

namespace fdcg {
namespace {

uint64_t word_at(const unsigned char* data, uint64_t at, uint64_t bytes) {
  uint64_t word = 0;
  for (int i = 0; i < 8 && at + static_cast<uint64_t>(i) < bytes; ++i)
    word |= uint64_t{data[at + static_cast<uint64_t>(i)]} << 8 * i;
  return word;
}

uint64_t small_block_sum(const unsigned char* data, uint64_t bytes) {
  uint64_t lanes[kLaneCount], sum = kSeed ^ bytes;
  for (uint64_t i = 0; i < kLaneCount; ++i)
    lanes[i] = kSeed + i * kMultiplier;
  for (uint64_t stripe = 0; stripe < bytes; stripe += kStripe) {
    for (uint64_t i = 0; i < kLaneCount; ++i)
      lanes[i] = absorbed(lanes[i], word_at(data, stripe + 8 * i, bytes));
  }
  for (const uint64_t lane : lanes)
    sum = absorbed(sum, lane);
  return sum;
}

}  // namespace

uint64_t checksum_start(uint64_t bytes) {
  return kSeed + bytes * kMultiplier;
}

uint64_t small_checksum(const void* data, uint64_t bytes) {
  uint64_t sum = checksum_start(bytes);
  for (uint64_t at = 0; at < bytes; at += kChecksumBlock) {
    const uint64_t left = bytes - at;
    const auto* const block = static_cast<const unsigned char*>(data) + at;
    sum += mixed_in(small_block_sum(block, left < kChecksumBlock ? left : kChecksumBlock), at / kChecksumBlock);
  }
  return sum;
}

}  // namespace fdcg
