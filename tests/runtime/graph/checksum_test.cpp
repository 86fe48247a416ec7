// SPDX-License-Identifier: Apache-2.0
// What the format's checksum notices (schemas/fdcg-v1.md, Checksum).
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "catch.hpp"
#include "fdcg/fdcg.h"
#include "random.hpp"

namespace {

// Whatever a block's bytes are: none, and drawn ones.
template <int kBytes>
std::array<unsigned char, kBytes> content(bool drawn) {
  std::array<unsigned char, kBytes> bytes{};
  fdcg::test::Random random(18);
  for (unsigned char& byte : bytes)
    byte = drawn ? static_cast<unsigned char>(random.below(256)) : 0;
  return bytes;
}

void flip(unsigned char* bytes, int bit) {
  bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ 1 << bit % 8);
}

// As the schema has it, word by word.
std::uint64_t by_the_schema(const std::vector<unsigned char>& bytes) {
  constexpr std::uint64_t kK = 0x9E3779B97F4A7C15, kF = 0x9E3779B1, kG = 0x85EBCA77, kS = 0x4644434700000003;
  const auto absorbed = [&](std::uint64_t lane, std::uint64_t word) {
    lane ^= word;
    lane += (lane & 0xFFFFFFFF) * (kF - 1);
    lane = lane << 32 | lane >> 32;
    return lane + (lane & 0xFFFFFFFF) * (kG - 1);
  };
  std::uint64_t checksum = kS + bytes.size() * kK;
  for (std::size_t block = 0; block * 4096 < bytes.size(); ++block) {
    const std::size_t begin = block * 4096, end = std::min(begin + 4096, bytes.size());
    std::array<std::uint64_t, 16> lanes;
    for (std::size_t i = 0; i < 16; ++i)
      lanes[i] = kS + i * kK;
    for (std::size_t at = begin; at < end; at += 128) {
      for (std::size_t i = 0; i < 16; ++i) {
        std::uint64_t word = 0;
        for (std::size_t k = at + 8 * i; k < std::min(at + 8 * i + 8, end); ++k)
          word |= std::uint64_t{bytes[k]} << 8 * (k - at - 8 * i);
        lanes[i] = absorbed(lanes[i], word);
      }
    }
    std::uint64_t sum = kS ^ (end - begin);
    for (const std::uint64_t lane : lanes)
      sum = absorbed(sum, lane);
    std::uint64_t part = (sum + block * kK) * kK;
    part = (part ^ part >> 32) * kK;
    checksum += part;
  }
  return checksum;
}

}  // namespace

TEST_CASE("the checksum is that of the schema, however many blocks are summed at once") {
  fdcg::test::Random random(20);
  for (const std::size_t size :
       {0, 1, 8, 127, 128, 4095, 4096, 4097, 8191, 8192, 8193, 12287, 12288, 16384, 20480, 24577, 65535}) {
    std::vector<unsigned char> bytes(size);
    for (unsigned char& byte : bytes)
      byte = static_cast<unsigned char>(random.below(256));
    INFO(size);
    CHECK(fdcg_checksum(bytes.data(), size) == by_the_schema(bytes));
  }
}

TEST_CASE("two changed bits always change the checksum") {
  constexpr int kBytes = 400;  // four stripes, the last one short: each word meets those that come next in its lane
  for (const bool drawn : {false, true}) {
    auto bytes = content<kBytes>(drawn);
    const std::uint64_t whole = fdcg_checksum(bytes.data(), kBytes);
    int unseen = 0;
    for (int a = 0; a < 8 * kBytes; ++a) {
      flip(bytes.data(), a);
      for (int b = 0; b < a; ++b) {
        flip(bytes.data(), b);
        unseen += fdcg_checksum(bytes.data(), kBytes) == whole;
        flip(bytes.data(), b);
      }
      flip(bytes.data(), a);
    }
    CHECK(unseen == 0);
  }
}

TEST_CASE("equal changes of a word's half and of a word further on change the checksum") {
  // as where one value replaces another in two records
  constexpr int kBytes = 512;
  fdcg::test::Random random(19);
  auto bytes = content<kBytes>(true);
  const std::uint64_t whole = fdcg_checksum(bytes.data(), kBytes);
  int unseen = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto change = static_cast<std::uint32_t>(random.below(1u << 31) + 1);
    for (int a = 0; a < kBytes; a += 4) {
      for (int far = 4; far <= 256 && a + far < kBytes; far += 4) {
        if (far != 124 && far != 128 && far != 132 && far != 256 && round > 20) continue;
        auto changed = bytes;
        for (int i = 0; i < 4; ++i) {
          changed[static_cast<std::size_t>(a + i)] ^= static_cast<unsigned char>(change >> 8 * i);
          changed[static_cast<std::size_t>(a + far + i)] ^= static_cast<unsigned char>(change >> 8 * i);
        }
        unseen += fdcg_checksum(changed.data(), kBytes) == whole;
      }
    }
  }
  CHECK(unseen == 0);
}
