// SPDX-License-Identifier: Apache-2.0
// Who may be inside a device's transport. The supervisor opens and closes it; the reader and the writer go in only while it is
// open, and it is closed only once both are out. No lock: each side first says what it is about to do, then looks at what the
// other has said (sequentially consistent, so that at least one of them sees the other).
#pragma once

#include <atomic>
#include <cstdint>

namespace fdcg::dev {

class Link {
 public:
  enum Party { kReader = 0, kWriter = 1 };

  // The reader's and the writer's. False: it is closed; stay out.
  bool enter(Party party) {
    inside_[party].store(true);
    if (is_open_.load()) return true;
    inside_[party].store(false);
    return false;
  }
  void leave(Party party) { inside_[party].store(false); }

  // The supervisor's. After close() nobody enters; the transport may be closed when is_empty().
  void open() {
    opened_.fetch_add(1);
    is_open_.store(true);
  }
  void close() { is_open_.store(false); }
  bool is_empty() const { return !inside_[kReader].load() && !inside_[kWriter].load(); }

  // Anybody's.
  bool is_open() const { return is_open_.load(std::memory_order_acquire); }
  std::uint64_t opened() const { return opened_.load(std::memory_order_acquire); }  // how often

 private:
  std::atomic<bool> is_open_{false};
  std::atomic<std::uint64_t> opened_{0};
  alignas(64) std::atomic<bool> inside_[2] = {};
};

}  // namespace fdcg::dev
