// SPDX-License-Identifier: Apache-2.0
// Counts calls of heap and locks on one thread, the one that starts the count, and times what it spends in waking others.
#pragma once

#include <cstdint>

namespace fdcg::dev::test {

struct ThreadCalls {
  std::uint64_t heap = 0, locks = 0;
};

bool can_count_thread_calls();  // not under sanitizers, which have their own heap
void count_calls_of_this_thread(bool is_counting);
ThreadCalls thread_calls();              // so far, of the thread that counts
std::int64_t futex_ns_of_this_thread();  // processor time of its futex calls while it counted, each with one look at that clock

}  // namespace fdcg::dev::test
