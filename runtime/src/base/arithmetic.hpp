// SPDX-License-Identifier: Apache-2.0
// What the step's promises rest on: each operation of IEEE 754 rounded once, to nearest. Options of a compiler that break this
// are refused where the library is compiled, states of a processor where a graph is opened.
#pragma once

#include <float.h>

#include "fdcg/fdcg.h"

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "fdcg: -ffast-math and -ffinite-math-only take away what the step promises of NaN and of rounding; leave them out"
#endif
#if FLT_EVAL_METHOD != 0
#error "fdcg: this target computes wider than a number's type; on i386 compile with -msse2 -mfpmath=sse"
#endif

namespace fdcg {

// FDCG_E_ARITHMETIC, with what is otherwise, unless numbers are rounded to nearest, subnormal ones are kept, and products are
// rounded before they are added. Some 20 operations.
fdcg_status check_arithmetic(fdcg_error* error);

}  // namespace fdcg
