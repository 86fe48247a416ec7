// SPDX-License-Identifier: Apache-2.0
#include "step_time_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"

using fdcg::servo::StepTimeHistogram;

TEST_CASE("quantiles of an empty histogram are 0") {
  CHECK(StepTimeHistogram().quantile(0.5) == 0);
}

TEST_CASE("small numbers are counted exactly") {
  StepTimeHistogram histogram;
  for (std::uint64_t value = 1; value <= 60; ++value)
    histogram.add(value);
  CHECK(histogram.quantile(0.5) == 30);
  CHECK(histogram.quantile(0.99) == 60);
  CHECK(histogram.quantile(0) == 1);
  CHECK(histogram.count_between(16, 32) == 16);
}

TEST_CASE("quantiles lie within one part in 64 below the sorted numbers', over the whole range") {
  std::mt19937_64 random(7);
  std::vector<std::uint64_t> values;
  StepTimeHistogram histogram;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(random() >> (random() % 64));
    histogram.add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double fraction : {0.001, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const std::uint64_t exact = values[static_cast<std::size_t>(std::ceil(fraction * 20000)) - 1];
    CHECK(histogram.quantile(fraction) <= exact);
    CHECK(histogram.quantile(fraction) >= exact - exact / 64);
  }
  CHECK(histogram.largest() == values.back());
}

TEST_CASE("counts between powers of two add up") {
  StepTimeHistogram histogram;
  for (std::uint64_t value = 0; value < 5000; ++value)
    histogram.add(value);
  CHECK(histogram.count_between(0, 16) == 16);
  CHECK(histogram.count_between(1024, 2048) == 1024);
  CHECK(histogram.count_between(4096, 8192) == 5000 - 4096);
}
