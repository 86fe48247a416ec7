// SPDX-License-Identifier: Apache-2.0
// Layout of caller-owned memory: a struct followed by its arrays, addressed by offsets, so that a byte copy of the whole is
// valid.
#pragma once

#include "base/message.hpp"

namespace fdcg {

// Computes the offsets of consecutive parts, each a multiple of 8.
class MemoryLayout {
 public:
  static constexpr uint64_t kAlignment = 8;

  // The offset of the next part: `count` things of `bytes` each.
  uint64_t place(uint64_t count, uint64_t bytes) {
    const uint64_t begin = end_;
    end_ += (count * bytes + kAlignment - 1) / kAlignment * kAlignment;
    return begin;
  }
  [[nodiscard]] uint64_t bytes() const { return end_; }

 private:
  uint64_t end_ = 0;
};

// Whether such a layout fits at `memory`, which is not null; `what` needs it.
inline fdcg_status check_room(const void* memory, uint64_t bytes, uint64_t needed, fdcg_error* error,
                              const char* what = "this config") {
  if (reinterpret_cast<uintptr_t>(memory) % MemoryLayout::kAlignment != 0)
    return Message(error, FDCG_E_ALIGNMENT).text("memory: does not start at a multiple of 8");
  if (bytes < needed) return Message(error, FDCG_E_ARGUMENT).say("bytes is ", bytes, ", ", what, " needs ", needed);
  return FDCG_OK;
}

// The part at an offset from `whole`; const if `whole` is.
template <class T, class Whole>
inline T* part_at(Whole* whole, uint64_t offset) {
  return reinterpret_cast<T*>(reinterpret_cast<char*>(whole) + offset);
}
template <class T, class Whole>
inline const T* part_at(const Whole* whole, uint64_t offset) {
  return reinterpret_cast<const T*>(reinterpret_cast<const char*>(whole) + offset);
}

}  // namespace fdcg
