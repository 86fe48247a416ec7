// SPDX-License-Identifier: Apache-2.0
// Processor time of the calling thread: the machine may be busy with others.
#pragma once

#include <cstdint>
#include <ctime>

namespace fdcg::dev::test {

inline std::int64_t spent_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// What a look at that clock, a call of the system, costs.
inline std::int64_t clock_cost_ns() {
  constexpr int kLooks = 1000;
  const std::int64_t before_ns = spent_ns();
  for (int look = 1; look < kLooks; ++look)
    spent_ns();
  return (spent_ns() - before_ns) / kLooks;
}

}  // namespace fdcg::dev::test
