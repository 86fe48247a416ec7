// SPDX-License-Identifier: Apache-2.0
// Replaces the C heap's entry points by ones that count and pass on: operator new ends there too.
#include "heap_count.hpp"

#include <cstddef>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FDCG_COUNTS_HEAP 1
#else
#define FDCG_COUNTS_HEAP 0
#endif

namespace {
std::uint64_t calls;  // benchmarks step on one thread; a lost count of the compiler's threads does no harm
}

#if FDCG_COUNTS_HEAP
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  ++calls;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++calls;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++calls;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++calls;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++calls;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? 12 /* ENOMEM */ : 0;
}
void free(void* block) {
  ++calls;
  __libc_free(block);
}
}
#endif

namespace fdcg::test {

std::uint64_t heap_calls() {
  return calls;
}
bool can_count_heap_calls() {
  return FDCG_COUNTS_HEAP != 0;
}

}  // namespace fdcg::test
