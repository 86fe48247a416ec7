// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>

#include <cstdint>

#include "base/large_pages.hpp"

namespace fdcg::bake {

void prefer_large_pages(void* memory, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kPage = 4096, kWorthwhile = std::uintptr_t{8} << 20;
  if (bytes < kWorthwhile) return;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + kPage - 1) / kPage * kPage;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / kPage * kPage;
  (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // a hint: a failure is ignored
#else
  (void)memory;
  (void)bytes;
#endif
}

}  // namespace fdcg::bake
