// SPDX-License-Identifier: Apache-2.0
// Interposes the C library's heap and lock functions, counts calls on registered threads, and forwards them.
#include "thread_calls.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>

#include <atomic>
#include <cstdarg>
#include <cstddef>
#include <cstdlib>

#include "spent_time.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FDCG_COUNTS 1
#else
#define FDCG_COUNTS 0
#endif

namespace {

thread_local bool is_counted = false;
thread_local std::int64_t futex_ns = 0;
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

// The futex calls of threads that count are timed: by them an event wakes another thread.
extern "C" long syscall(long number, ...) noexcept {
  static std::atomic<long (*)(long, ...)> real{nullptr};
  if (real.load() == nullptr) real.store(next<long (*)(long, ...)>("syscall"));
  va_list list;
  va_start(list, number);
  long arguments[6];
  for (long& argument : arguments)
    argument = va_arg(list, long);
  va_end(list);
  const bool is_timed = is_counted && number == SYS_futex;
  const std::int64_t before_ns = is_timed ? fdcg::dev::test::spent_ns() : 0;
  const long result = real.load()(number, arguments[0], arguments[1], arguments[2], arguments[3], arguments[4], arguments[5]);
  if (is_timed) futex_ns += fdcg::dev::test::spent_ns() - before_ns;
  return result;
}
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
std::int64_t futex_ns_of_this_thread() {
  return futex_ns;
}

}  // namespace fdcg::dev::test
