// SPDX-License-Identifier: Apache-2.0
// Floating-point exceptions as faults around a step: with a HIP of finite numbers it makes no NaN, divides nothing by zero and
// overflows nowhere, not even in between.
#pragma once

#include <fenv.h>

#include <cmath>

#if defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define FDCG_FP_TRAP 1
#else
#define FDCG_FP_TRAP 0
#endif

namespace fdcg::test {

// Traps while it lives; Catch reports the SIGFPE as a failure. A NaN or an infinity that comes in as the HIP is a case of its
// own and traps nothing. Without glibc, or with Clang, which may divide before it knows that it has to, it does nothing.
class FpTrap {
 public:
  explicit FpTrap(const double hip[3]) {
    if (!(std::isfinite(hip[0]) && std::isfinite(hip[1]) && std::isfinite(hip[2]))) return;
#if FDCG_FP_TRAP
    feclearexcept(kTrapped);
    before_ = fegetexcept();
    feenableexcept(kTrapped);
    is_on_ = true;
#endif
  }
  ~FpTrap() {
#if FDCG_FP_TRAP
    if (!is_on_) return;
    fedisableexcept(kTrapped);
    feenableexcept(before_);
#endif
  }
  FpTrap(const FpTrap&) = delete;
  FpTrap& operator=(const FpTrap&) = delete;

 private:
  static constexpr int kTrapped = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
  [[maybe_unused]] int before_ = 0;
  [[maybe_unused]] bool is_on_ = false;
};

}  // namespace fdcg::test
