// SPDX-License-Identifier: Apache-2.0
// Vectors of 32 bytes where the processor that runs the code has them: functions for it have the attribute FDCG_AVX2, and are
// called where has_avx2(). Not on Windows, where GCC does not align such vectors on the stack (its bug 54412).
#pragma once

#if defined(__x86_64__) && !defined(_WIN32)
#define FDCG_MAY_HAVE_AVX2 1
#include <immintrin.h>
#define FDCG_AVX2 gnu::target("avx2")

namespace fdcg {

inline bool has_avx2() {
  return __builtin_cpu_supports("avx2") != 0;
}

}  // namespace fdcg

#else
#define FDCG_MAY_HAVE_AVX2 0
#endif
