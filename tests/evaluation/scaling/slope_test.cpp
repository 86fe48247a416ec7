// SPDX-License-Identifier: Apache-2.0
#include "slope.hpp"

#include <cmath>

#include "catch.hpp"

using namespace fdcg::test;

TEST_CASE("the exponent of a power law is found at any scale") {
  for (const double power : {-1.0, 0.0, 0.5, 1.0, 1.5}) {
    Series series;
    for (double x = 10; x < 1e7; x *= 10)
      series.emplace_back(x, 3e-9 * std::pow(x, power));
    CHECK(exponent_of(series) == Approx(power).margin(1e-12));
  }
}

TEST_CASE("n log n is told from n and from n squared") {
  Series series;
  for (double x = 1e4; x < 2e7; x *= 10)
    series.emplace_back(x, x * std::log(x));
  CHECK(exponent_of(series) > 1.05);
  CHECK(exponent_of(series) < 1.12);
}

TEST_CASE("small sizes and values that say nothing are left out") {
  const Series series = {{1, 100}, {10, 100}, {100, 100}, {1000, 1000}, {10000, 0}};
  CHECK(exponent_of(series, 100) == Approx(1));
  CHECK(std::isnan(exponent_of(series, 1000)));
  CHECK(std::isnan(exponent_of({{5, 1}, {5, 2}})));
}
