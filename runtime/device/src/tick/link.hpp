// SPDX-License-Identifier: Apache-2.0
// Access control of a device's transport. The supervisor opens and closes it; the reader, the writer and who stands in for the
// writer use it only while it is open, and it is closed only when none of them is using it. Lock-free: each side first stores
// its own flag, then reads the other's (sequentially consistent, so that at least one of them sees the other).
#pragma once

#include <atomic>
#include <cstdint>

namespace fdcg::dev {

class Link {
 public:
  enum Party { kReader = 0, kWriter = 1, kStandIn = 2 };

  // For each of the three. False: it is closed and must not be used.
  bool enter(Party party) {
    inside_[party].store(true);
    if (is_open_.load()) return true;
    inside_[party].store(false);
    return false;
  }
  void leave(Party party) { inside_[party].store(false); }

  // For the supervisor. After close() no thread can enter; the transport may be closed when is_empty().
  void open() {
    opened_.fetch_add(1);
    is_open_.store(true);
  }
  void close() { is_open_.store(false); }
  bool is_empty() const { return !inside_[kReader].load() && !inside_[kWriter].load() && !inside_[kStandIn].load(); }

  // For any thread.
  bool is_open() const { return is_open_.load(std::memory_order_acquire); }
  std::uint64_t opened() const { return opened_.load(std::memory_order_acquire); }  // how often

 private:
  std::atomic<bool> is_open_{false};
  std::atomic<std::uint64_t> opened_{0};
  alignas(64) std::atomic<bool> inside_[3] = {};
};

}  // namespace fdcg::dev
