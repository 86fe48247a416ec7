// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "base/raw_array.hpp"

namespace fdcg::bake {

// Sorts by key(item), which is below 2^bits, stable, least significant digit first: equal keys stay in their order, and the
// outcome does not depend on `jobs`. Fewer than 2^32 items; takes as much memory again while it runs.
template <class Item, class Key>
void radix_sort(RawArray<Item>& items, unsigned bits, unsigned jobs, const Key& key) {
  constexpr unsigned kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  constexpr std::size_t kWorthThreads = 100'000;  // items, some milliseconds; a thread costs a tenth of one
  const std::size_t count = items.size();
  const std::size_t ranges = count < kWorthThreads ? 1 : jobs, width = (count + ranges - 1) / ranges;
  const auto digit = [&](const Item& item, unsigned shift) {
    return static_cast<std::size_t>(key(item) >> shift) & (kDigits - 1);
  };
  RawArray<Item> sorted(count);
  std::vector<std::array<std::uint32_t, kDigits>> place(ranges);
  for (unsigned shift = 0; shift < bits; shift += kDigitBits) {
    parallel_for(jobs, ranges, 1, [&](std::size_t range, std::size_t) {
      place[range].fill(0);
      for (std::size_t i = range * width; i < std::min(count, (range + 1) * width); ++i)
        ++place[range][digit(items[i], shift)];
    });
    std::uint32_t sum = 0;
    for (std::size_t d = 0; d < kDigits; ++d) {
      for (std::size_t range = 0; range < ranges; ++range)
        sum += std::exchange(place[range][d], sum);
    }
    parallel_for(jobs, ranges, 1, [&](std::size_t range, std::size_t) {
      std::array<std::uint32_t, kDigits>& next = place[range];
      for (std::size_t i = range * width; i < std::min(count, (range + 1) * width); ++i)
        sorted[next[digit(items[i], shift)]++] = items[i];
    });
    std::swap(items, sorted);
  }
}

}  // namespace fdcg::bake
