// SPDX-License-Identifier: Apache-2.0
// Independent pieces of work on a few threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace fdcg::test {

// work(0) .. work(count - 1), each once, in any order: what they find must go to places of their own, so that the outcome does
// not depend on the number of threads. The first exception is thrown on, after all threads have stopped.
template <class Work>
void for_each_index(std::size_t count, unsigned threads, Work work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++)
        work(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> others;
  for (unsigned k = 1; k < threads; ++k)
    others.emplace_back(run);
  run();
  for (std::thread& other : others)
    other.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace fdcg::test
