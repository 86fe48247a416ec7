// SPDX-License-Identifier: Apache-2.0
// A queue of fixed length from one thread to another; neither waits. Where it is full, what is put is dropped and counted.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fdcg::dev {

template <class T>
class Ring {
 public:
  // Before its threads run. 0: there is none, and all is dropped without being counted.
  void resize(std::size_t slots) { slots_.resize(slots); }
  std::size_t size() const { return slots_.size(); }

  // Sender's: the slot to fill, and its hand-over. Null: it is full.
  T* next() {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (slots_.empty()) return nullptr;
    if (head - tail_.load(std::memory_order_acquire) < slots_.size()) return &slots_[head % slots_.size()];
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  void put() { head_.fetch_add(1, std::memory_order_release); }

  // Receiver's: the oldest, up to `most` of them. How many.
  std::size_t take(T* values, std::size_t most) {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    const auto count = std::min<std::size_t>(head_.load(std::memory_order_acquire) - tail, most);
    for (std::size_t i = 0; i < count; ++i)
      values[i] = slots_[(tail + i) % slots_.size()];
    tail_.store(tail + count, std::memory_order_release);
    return count;
  }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::vector<T> slots_;
  std::atomic<std::uint64_t> head_{0}, tail_{0}, dropped_{0};
};

}  // namespace fdcg::dev
