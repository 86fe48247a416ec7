// SPDX-License-Identifier: Apache-2.0
// Counts of many whole numbers (nanoseconds, transitions) in constant memory, with quantiles good to one part in 64.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace fdcg::servo {

// Numbers below 64 have a bin each; above, every doubling is cut into 64 bins of one width.
class StepTimeHistogram {
 public:
  void add(std::uint64_t value) {
    ++bins_[bin_of(value)];
    ++count_;
    largest_ = std::max(largest_, value);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::uint64_t largest() const { return largest_; }

  // The least value that `fraction` of the numbers do not exceed, rounded down to its bin. 0 where nothing was added.
  [[nodiscard]] std::uint64_t quantile(double fraction) const {
    const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count_))));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
      seen += bins_[bin];
      if (seen >= rank) return lower_end(bin);
    }
    return largest_;
  }

  // How many numbers lie in [low, high); both powers of two or 0.
  [[nodiscard]] std::uint64_t count_between(std::uint64_t low, std::uint64_t high) const {
    std::uint64_t sum = 0;
    for (std::size_t bin = bin_of(low), end = bin_of(high); bin < end; ++bin)
      sum += bins_[bin];
    return sum;
  }

 private:
  static constexpr std::uint64_t kSubBins = 64;
  static constexpr int kSubBits = 6;
  static constexpr int kDoublings = 64 - kSubBits;

  static std::size_t bin_of(std::uint64_t value) {
    if (value < kSubBins) return value;
    const int doubling = std::bit_width(value) - kSubBits - 1;
    return static_cast<std::size_t>(static_cast<std::uint64_t>(doubling) * kSubBins + (value >> doubling));
  }
  static std::uint64_t lower_end(std::size_t bin) {
    if (bin < kSubBins) return bin;
    const std::uint64_t doubling = bin / kSubBins - 1;
    return (bin - doubling * kSubBins) << doubling;
  }

  std::array<std::uint64_t, kSubBins*(kDoublings + 1)> bins_{};
  std::uint64_t count_ = 0;
  std::uint64_t largest_ = 0;
};

}  // namespace fdcg::servo
