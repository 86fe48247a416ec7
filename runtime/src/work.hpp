// SPDX-License-Identifier: Apache-2.0
// What the free-space sweep counts, so that it ends in bounded time whatever the mesh: units of some 10 instructions.
#pragma once

#include <stdint.h>

namespace fdcg {

// Of one step, all its sweeps together: some 15,000 instructions, 3 microseconds at 2.8 GHz.
#ifndef FDCG_SWEEP_WORK
#define FDCG_SWEEP_WORK 1500
#endif
inline constexpr uint32_t kSweepWork = FDCG_SWEEP_WORK;

inline constexpr uint32_t kBoxWork = 3;          // one box tested
inline constexpr uint32_t kNodeWork = 2;         // one node fetched, one end of the way against its plane
inline constexpr uint32_t kOrientationWork = 4;  // one side's edge against the way, where rounding cannot matter
inline constexpr uint32_t kExactWork = 8;        // ... and where it does

// Takes `units` off what is left; at nothing left stays there.
inline void spend(uint32_t* work_left, uint32_t units) {
  *work_left = *work_left > units ? *work_left - units : 0;
}

}  // namespace fdcg
