// SPDX-License-Identifier: Apache-2.0
// How often the program has asked the heap for memory or given it back.
#pragma once

#include <cstdint>

namespace fdcg::test {

// Calls of malloc, calloc, realloc, free and their kin so far, from any code. Counted with glibc and without sanitizers; else
// always 0, which can_count_heap_calls() tells.
std::uint64_t heap_calls();
bool can_count_heap_calls();

}  // namespace fdcg::test
