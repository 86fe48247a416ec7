// SPDX-License-Identifier: Apache-2.0
// How precisely a text prints its coordinates.
#pragma once

#include "import/text_scanner.hpp"

namespace fdcg::bake {

// How a number stands in a text: its decimals (TextScanner::kNoDecimals: it tells nothing), and its digits.
struct Printed {
  int decimals = TextScanner::kNoDecimals;
  int digits = 0;
};
[[nodiscard]] inline Printed printed(const TextScanner& scan) {
  return {scan.last_decimals(), scan.last_digits()};
}

class PrintedPrecision {
 public:
  void note(double value, const Printed& number) {
    if (number.decimals == TextScanner::kNoDecimals) return;
    if (number.decimals > finest_decimals_) finest_decimals_ = number.decimals;
    if (prints_floats_ && number.digits > kFewDigits) look_for_float(value, number);
  }

  // Half a unit of the last digit of the most precisely printed number, at most a share of the extent. Integers are taken as
  // exact (0): they come from grids, voxels and manual modelling and not from rounding, and half a unit would flatten a unit
  // cube.
  [[nodiscard]] double half_step(double extent) const;

  // Numbers of seven digits and more that all are floats, printed with up to nine digits or in full, were floats.
  [[nodiscard]] bool are_floats() const { return prints_floats_ && has_long_numbers_; }

 private:
  void look_for_float(double value, const Printed& number);

  static constexpr int kFewDigits = 6;  // every decimal of so few digits is some float's shortest one, and tells nothing
  int finest_decimals_ = TextScanner::kNoDecimals;
  bool prints_floats_ = true;  // no number was seen that is not a float's
  bool has_long_numbers_ = false;
};

}  // namespace fdcg::bake
