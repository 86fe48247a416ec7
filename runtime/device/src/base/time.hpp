// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace fdcg::dev {

// 0 where the second is not later.
inline double seconds(std::uint64_t from_ns, std::uint64_t to_ns) {
  return to_ns > from_ns ? static_cast<double>(to_ns - from_ns) * 1e-9 : 0;
}

}  // namespace fdcg::dev
