// SPDX-License-Identifier: Apache-2.0
// The one exact predicate that the inside grid needs.
#pragma once

#include "hip_walk.hpp"

namespace fdcg::test {

// The sign of ((b - a) x (c - a)) . (d - a), exact. Cost: some 10 ns where rounding cannot matter, some
// hundreds where it can.
int exact_sign(const Hip& a, const Hip& b, const Hip& c, const Hip& d);

}  // namespace fdcg::test
