// SPDX-License-Identifier: Apache-2.0
#include "host/status.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"

using fdcg::dev::TimeHistogram;

TEST_CASE("a quantile of times is at least the true one, and at most a fourth root of two above it") {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> exponent(6.1, 37);
  for (int round = 0; round < 20; ++round) {
    TimeHistogram histogram;
    std::vector<std::uint64_t> times;
    const double centre = exponent(random);
    for (int i = 0; i < 5000; ++i) {
      times.push_back(
          static_cast<std::uint64_t>(std::exp2(std::clamp(centre + std::normal_distribution<double>()(random), 6.1, 37.0))));
      histogram.add(times.back());
    }
    std::sort(times.begin(), times.end());
    for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto rank = static_cast<std::size_t>(std::ceil(share * 5000)) - 1;
      const auto truth = static_cast<double>(times[rank]);
      REQUIRE(static_cast<double>(histogram.quantile(share)) >= truth);
      REQUIRE(static_cast<double>(histogram.quantile(share)) <= truth * 1.19 + 1);
    }
    REQUIRE(histogram.total == 5000);
    REQUIRE(histogram.largest_ns == times.back());
    REQUIRE(histogram.quantile(1) == times.back());
  }
}

TEST_CASE("every time has a bin, also zero and the longest") {
  TimeHistogram histogram;
  CHECK(histogram.quantile(0.5) == 0);
  histogram.add(0);
  CHECK(histogram.quantile(0.5) == 0);
  CHECK(histogram.counts[0] == 1);
  histogram.add(~std::uint64_t{0});
  CHECK(histogram.counts[TimeHistogram::kBins - 1] == 1);
  CHECK(histogram.largest_ns == ~std::uint64_t{0});
  std::uint64_t before = 0;
  int bins_used = 0;
  for (double time = 64; time < 1e11; time *= 1.05) {
    TimeHistogram one;
    one.add(static_cast<std::uint64_t>(time));
    one.add(static_cast<std::uint64_t>(time) * 1000);  // so that the first is told by its bin
    const std::uint64_t end = one.quantile(0.5);
    CHECK(end >= before);  // longer times are never in earlier bins
    bins_used += end > before;
    before = end;
  }
  CHECK(bins_used > 110);
}
