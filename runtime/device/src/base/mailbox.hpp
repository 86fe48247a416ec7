// SPDX-License-Identifier: Apache-2.0
// The newest value, from one thread to another: the writer of values never waits, the reader gets the newest whole one. Three
// slots: one being filled, one being read, one between them.
#pragma once

#include <atomic>
#include <cstdint>

namespace fdcg::dev {

template <class T>
class Mailbox {
 public:
  // Sender's.
  void put(const T& value) {
    slots_[filling_] = value;
    filling_ = between_.exchange(static_cast<std::uint8_t>(filling_ | kFresh), std::memory_order_acq_rel) & kSlot;
  }
  // Receiver's. False: nothing new; *value stays.
  bool take(T* value) {
    if (!(between_.load(std::memory_order_relaxed) & kFresh)) return false;
    reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    *value = slots_[reading_];
    return true;
  }

 private:
  static constexpr std::uint8_t kSlot = 3, kFresh = 4;
  T slots_[3] = {};
  std::uint8_t filling_ = 0, reading_ = 2;
  std::atomic<std::uint8_t> between_{1};
};

}  // namespace fdcg::dev
