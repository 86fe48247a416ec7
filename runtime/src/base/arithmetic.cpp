// SPDX-License-Identifier: Apache-2.0
#include "base/arithmetic.hpp"

#include "base/message.hpp"

namespace fdcg {
namespace {

// In float alone: where a processor has both, one register rules both, and where it has no doubles the compiler's own are
// right.

// Through memory, so that the processor computes what a compiler would know.
float seen(float value) {
  volatile float kept = value;
  return kept;
}

// 1 and a hundredth of the distance to its neighbours is 1, from both sides: rounded up, down or to zero, one is not.
bool rounds_to_nearest() {
  const float one = seen(1), little = seen(FLT_EPSILON / 100);
  return seen(one + little) == one && seen(one - little) == one;
}

// A number below the least normal one is neither made zero (flush to zero) nor read as zero (denormals are zero).
bool keeps_subnormals() {
  const float half = seen(seen(FLT_MIN) / 2);
  return half != 0 && seen(half * 2) == FLT_MIN;
}

// (1 + e)^2 - (1 + 2 e), where e^2 is below half of what the product is rounded to: 0 unless product and sum are one operation.
bool rounds_products() {
  constexpr float kSmall = 0x1p-13F;
  const float factor = seen(1 + kSmall), rounded = seen(1 + 2 * kSmall);
  const float left = factor * factor - rounded;
  return seen(left) == 0;
}

}  // namespace

fdcg_status check_arithmetic(fdcg_error* error) {
  if (!rounds_to_nearest()) {
    return refuse(error, FDCG_E_ARITHMETIC,
                  "the processor's rounding mode is not to nearest; set it back (fesetround(FE_TONEAREST)) in each thread that "
                  "opens or steps graphs");
  }
  if (!keeps_subnormals()) {
    return refuse(error, FDCG_E_ARITHMETIC,
                  "the processor flushes subnormal numbers to zero; switch that off in each thread that opens or steps graphs "
                  "(programs linked with -ffast-math switch it on when they start)");
  }
  if (!rounds_products()) {
    return refuse(error, FDCG_E_ARITHMETIC,
                  "the library was compiled with products and sums contracted; compile it with -ffp-contract=off");
  }
  return FDCG_OK;
}

}  // namespace fdcg
