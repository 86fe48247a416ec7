// SPDX-License-Identifier: Apache-2.0
#include "base/radix_sort.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "catch.hpp"

using namespace fdcg::bake;

namespace {

struct Numbered {
  std::uint64_t key;
  std::uint32_t number;
};

// Keys of so many bits, below others that do not count; many are equal where there are few.
RawArray<Numbered> random_items(std::size_t count, unsigned bits, std::uint64_t ignored) {
  std::mt19937_64 random(count + bits);
  RawArray<Numbered> items(count);
  for (std::uint32_t i = 0; i < count; ++i)
    items[i] = {(random() & ((std::uint64_t{1} << bits) - 1)) << 8 | (ignored & 0xFF), i};
  return items;
}

}  // namespace

TEST_CASE("radix_sort gives what a stable sort gives, on any number of threads") {
  const auto key = [](const Numbered& item) { return item.key >> 8; };
  for (const std::size_t count : {0U, 1U, 2U, 1000U, 99'999U, 100'000U, 250'001U}) {
    for (const unsigned bits : {1U, 11U, 12U, 30U, 48U}) {
      const RawArray<Numbered> items = random_items(count, bits, count);
      std::vector<Numbered> expected(items.begin(), items.end());
      std::stable_sort(expected.begin(), expected.end(), [&](const Numbered& a, const Numbered& b) { return key(a) < key(b); });
      for (const unsigned jobs : {1U, 2U, 7U}) {
        RawArray<Numbered> sorted(count);
        std::copy(items.begin(), items.end(), sorted.data());
        radix_sort(sorted, bits, jobs, key);
        const bool is_same = std::equal(expected.begin(), expected.end(), sorted.begin(),
                                        [](const Numbered& a, const Numbered& b) { return a.number == b.number; });
        CAPTURE(count, bits, jobs);
        CHECK(is_same);
      }
    }
  }
}
