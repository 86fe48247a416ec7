// SPDX-License-Identifier: Apache-2.0
// The unit of every error in this folder.
#pragma once

#include <cmath>

#include "fdcg/format.h"

namespace fdcg::test {

// The spacing of the file's numbers (double or float) at the object's extent, in the graph's units.
inline double ulp_of_extent(const fdcg_header& header) {
  constexpr int kDoubleBits = 52, kFloatBits = 23;  // of the mantissa
  return std::ldexp(1.0, std::ilogb(header.extent) - (header.real_bytes == sizeof(float) ? kFloatBits : kDoubleBits));
}

}  // namespace fdcg::test
