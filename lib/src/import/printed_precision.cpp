// SPDX-License-Identifier: Apache-2.0
#include "import/printed_precision.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace fdcg::bake {

void PrintedPrecision::look_for_float(double value, const Printed& number) {
  constexpr int kMostDigits = 9;  // that printing a float takes
  has_long_numbers_ = true;
  const double nearest = static_cast<double>(static_cast<float>(value));
  if (nearest == value) return;  // also one printed in full
  constexpr std::array kHalfUnits = {5e-1, 5e-2, 5e-3, 5e-4, 5e-5, 5e-6, 5e-7, 5e-8, 5e-9, 5e-10, 5e-11, 5e-12};
  const int decimals = number.decimals;
  const bool is_usual = decimals >= 0 && static_cast<std::size_t>(decimals) < kHalfUnits.size();
  const double half_unit = is_usual ? kHalfUnits[static_cast<std::size_t>(decimals)] : 0.5 * std::pow(10.0, -decimals);
  constexpr double kRounding = 1 + 1e-6;
  prints_floats_ = number.digits <= kMostDigits && std::fabs(value - nearest) <= half_unit * kRounding;
}

double PrintedPrecision::half_step(double extent) const {
  if (finest_decimals_ == TextScanner::kNoDecimals || finest_decimals_ <= 0) return 0;
  const std::string half_unit = "5e-" + std::to_string(std::int64_t{finest_decimals_} + 1);
  double value = 0;
  std::from_chars(half_unit.data(), half_unit.data() + half_unit.size(), value);  // left 0 where it is below every double
  // So few digits are typed values, not rounded ones: 0.3 beside 1 means 0.3. No exporter rounds this coarsely.
  constexpr double kLargestShare = 1e-5;
  return std::min(value, kLargestShare * extent);
}

}  // namespace fdcg::bake
