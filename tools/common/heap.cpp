// SPDX-License-Identifier: Apache-2.0
#include "heap.hpp"

#include <cstdint>
#include <cstdlib>  // and with it __GLIBC__
#include <limits>

#if defined(__GLIBC__) && defined(__linux__)
#include <malloc.h>
#include <sys/mman.h>
#endif

namespace fdcg::tools {

void keep_large_arrays() {
#if defined(__GLIBC__) && defined(__linux__)
  mallopt(M_ARENA_MAX, 1);  // what one thread frees serves all
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, 16 << 20);
  constexpr std::size_t kReach = std::size_t{512} << 20;  // of address space; memory is taken as it is used
  void* const heap = std::malloc(kReach);
  if (heap == nullptr) return;
  constexpr std::uintptr_t kPage = 4096;
  const auto begin = (reinterpret_cast<std::uintptr_t>(heap) + kPage - 1) / kPage * kPage;
  (void)madvise(reinterpret_cast<void*>(begin), kReach - kPage, MADV_HUGEPAGE);
  std::free(heap);
#endif
}

void keep_heap_top([[maybe_unused]] int bytes) {
#if defined(__GLIBC__) && defined(__linux__)
  mallopt(M_TRIM_THRESHOLD, bytes);
  mallopt(M_TOP_PAD, bytes / 4);
#endif
}

void give_back_free_memory() {
#if defined(__GLIBC__) && defined(__linux__)
  malloc_trim(0);
#endif
}

}  // namespace fdcg::tools
