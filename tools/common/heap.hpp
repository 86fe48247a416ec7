// SPDX-License-Identifier: Apache-2.0
// How the C library's heap treats a program that works through a few large arrays, one after the other.
#pragma once

namespace fdcg::tools {

// Freed arrays stay with the process and serve again, in large pages where the system has them: otherwise each stage faults
// its memory in anew, page by page. To be called once, before large allocations. A hint; does nothing where there is no glibc.
void keep_large_arrays();

// The same for many small ones: so many bytes at the top of the heap stay when they are freed.
void keep_heap_top(int bytes);

// Gives the system what is free in the heap: before one allocation apart from it that is larger than any array so far, and so
// cannot use it. A hint, like the other.
void give_back_free_memory();

}  // namespace fdcg::tools
