// SPDX-License-Identifier: Apache-2.0
// What the format's checksum notices (schemas/fdcg-v1.md, Checksum).
#include <array>
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

}  // namespace

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
