// SPDX-License-Identifier: Apache-2.0
#include "base/arithmetic.hpp"

#include "base/message.hpp"

namespace fdcg {
namespace {

// Through memory, so that the processor computes what a compiler would know.
template <class Real>
Real seen(Real value) {
  volatile Real kept = value;
  return kept;
}

// 1 and a hundredth of the distance to its neighbours is 1, from both sides and for both signs.
template <class Real>
bool rounds_to_nearest(Real epsilon) {
  const Real one = seen(Real(1)), little = seen(epsilon / 100);
  return seen(one + little) == one && seen(one - little) == one && seen(-one - little) == -one && seen(-one + little) == -one;
}

// A number below the least normal one is neither made zero (flush to zero) nor read as zero (denormals are zero).
template <class Real>
bool keeps_subnormals(Real least_normal) {
  const Real half = seen(seen(least_normal) / 2);
  return half != 0 && seen(half * 2) == least_normal;
}

// (1 + e)^2 - (1 + 2 e), where e^2 is below half of what the product is rounded to: 0 unless product and sum are one operation.
template <class Real>
bool rounds_products(Real small) {
  const Real factor = seen(1 + small), rounded = seen(1 + 2 * small);
  const Real left = factor * factor - rounded;
  return seen(left) == 0;
}

}  // namespace

fdcg_status check_arithmetic(fdcg_error* error) {
  if (!rounds_to_nearest(DBL_EPSILON) || !rounds_to_nearest(FLT_EPSILON)) {
    return refuse(error, FDCG_E_ARITHMETIC,
                  "the processor's rounding mode is not to nearest; set it back (fesetround(FE_TONEAREST)) in each thread that "
                  "opens or steps graphs");
  }
  if (!keeps_subnormals(DBL_MIN) || !keeps_subnormals(FLT_MIN)) {
    return refuse(error, FDCG_E_ARITHMETIC,
                  "the processor flushes subnormal numbers to zero; switch that off in each thread that opens or steps graphs "
                  "(programs linked with -ffast-math switch it on when they start)");
  }
  if (!rounds_products(0x1p-30) || !rounds_products(0x1p-13F)) {
    return refuse(error, FDCG_E_ARITHMETIC,
                  "the library was compiled with products and sums contracted; compile it with -ffp-contract=off");
  }
  return FDCG_OK;
}

}  // namespace fdcg
