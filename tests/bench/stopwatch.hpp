// SPDX-License-Identifier: Apache-2.0
// Time as finely as the machine tells it, and what a list of times says.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>
#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace fdcg::test {

// On x86-64 the time-stamp counter, fenced so that nothing of the work is left out; elsewhere the steady clock.
class Stopwatch {
 public:
  Stopwatch() {
    const auto clock_begin = std::chrono::steady_clock::now();
    const std::uint64_t begin = now();
    while (std::chrono::steady_clock::now() - clock_begin < std::chrono::milliseconds(50)) {
    }
    const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - clock_begin;
    ns_per_count_ = passed.count() / static_cast<double>(now() - begin);
    least_ = ~std::uint64_t{0};
    for (int i = 0; i < 10000; ++i) {
      const std::uint64_t a = now();
      least_ = std::min(least_, now() - a);
    }
  }

  static std::uint64_t now() {
#if defined(__x86_64__)
    _mm_lfence();
    const std::uint64_t count = __rdtsc();
    _mm_lfence();
    return count;
#else
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
  }

  // Between two readings, less what reading takes at least.
  [[nodiscard]] double nanoseconds(std::uint64_t begin, std::uint64_t end) const {
    const std::uint64_t passed = end - begin;
    return passed > least_ ? static_cast<double>(passed - least_) * ns_per_count_ : 0;
  }
  [[nodiscard]] double cost_ns() const {
    return static_cast<double>(least_) * ns_per_count_;
  }

 private:
  double ns_per_count_ = 1;
  std::uint64_t least_ = 0;
};

// Values sorted, to be asked for shares: at(0.99) is the 99th percentile, at(1) the largest.
// finely_at(): of times that a clock counts in steps, so that many are equal, as if these were spread evenly over their step.
class Percentiles {
 public:
  explicit Percentiles(std::vector<float> values) : values_(std::move(values)) { std::sort(values_.begin(), values_.end()); }
  [[nodiscard]] double at(double share) const {
    return values_.empty() ? 0 : values_[static_cast<std::size_t>(share * static_cast<double>(values_.size() - 1))];
  }
  [[nodiscard]] double finely_at(double share) const {
    const float value = static_cast<float>(at(share));
    const auto [begin, end] = std::equal_range(values_.begin(), values_.end(), value);
    if (begin == values_.begin() || end == values_.end()) return value;
    const double place = share * static_cast<double>(values_.size() - 1) + 0.5 - static_cast<double>(begin - values_.begin());
    const double low = (*(begin - 1) + value) / 2, high = (value + *end) / 2;
    return low + (high - low) * place / static_cast<double>(end - begin);
  }

 private:
  std::vector<float> values_;
};

}  // namespace fdcg::test
