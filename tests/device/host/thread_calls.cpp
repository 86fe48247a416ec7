// SPDX-License-Identifier: Apache-2.0
// Interposes the C library's heap and lock functions, counts calls on registered threads, and forwards them.
#include "thread_calls.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FDCG_COUNTS 1
#else
#define FDCG_COUNTS 0
#endif

namespace {

thread_local bool is_counted = false;
std::atomic<std::uint64_t> heap_calls, lock_calls;

[[maybe_unused]] void count(std::atomic<std::uint64_t>& calls) {
  if (is_counted) calls.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

#if FDCG_COUNTS
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  count(heap_calls);
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count(heap_calls);
  return __libc_calloc(number, size);
}
void* realloc(void* block, std::size_t size) {
  count(heap_calls);
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count(heap_calls);
  return __libc_memalign(alignment, size);
}
void free(void* block) {
  count(heap_calls);
  __libc_free(block);
}
}

namespace {

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// Found at the first call, which is before any thread counts; a magic static would lock by itself.
#define FDCG_COUNTED_LOCK(name, type)                                    \
  extern "C" int name(type* lock) {                                      \
    static std::atomic<int (*)(type*)> real{nullptr};                    \
    if (real.load() == nullptr) real.store(next<int (*)(type*)>(#name)); \
    count(lock_calls);                                                   \
    return real.load()(lock);                                            \
  }
FDCG_COUNTED_LOCK(pthread_mutex_lock, pthread_mutex_t)
FDCG_COUNTED_LOCK(pthread_mutex_trylock, pthread_mutex_t)
FDCG_COUNTED_LOCK(pthread_rwlock_rdlock, pthread_rwlock_t)
FDCG_COUNTED_LOCK(pthread_rwlock_wrlock, pthread_rwlock_t)
#endif

namespace fdcg::dev::test {

bool can_count_thread_calls() {
  return FDCG_COUNTS != 0;
}
void count_calls_of_this_thread(bool is_counting) {
  is_counted = is_counting;
}
ThreadCalls thread_calls() {
  return {heap_calls.load(), lock_calls.load()};
}

}  // namespace fdcg::dev::test
