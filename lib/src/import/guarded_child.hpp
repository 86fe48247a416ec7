// SPDX-License-Identifier: Apache-2.0
// Runs a function in a child process with limits on memory and time, and returns the bytes that it produces. For libraries that
// a forged file can make crash, loop or use up all memory. guarded_child_posix.cpp is the POSIX implementation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace fdcg::bake {

struct ChildLimits {
  std::size_t memory_bytes = 0;  // that the child may take beyond what this process has; four times that under sanitizers
  std::size_t answer_bytes = 0;  // that it may answer; only what it writes of them takes memory
  unsigned cpu_seconds = 0;      // of processor time, at least 1; of time on the clock twenty times that, plus a minute
};

// Writes the result. Exists in the child process.
class ChildAnswer {
 public:
  // Space for the next `bytes` of the answer, at a multiple of 8, zeroed. Throws beyond ChildLimits::answer_bytes: let it pass.
  virtual std::span<std::byte> append(std::size_t bytes) = 0;

 protected:
  ~ChildAnswer() = default;
};

// The child's result, in shared memory: it is not copied.
class ChildResult {
 public:
  ChildResult() = default;
  ChildResult(ChildResult&& other) noexcept;
  ChildResult& operator=(ChildResult&& other) noexcept;
  ChildResult(const ChildResult&) = delete;
  ChildResult& operator=(const ChildResult&) = delete;
  ~ChildResult();

  // Why there is no result, a phrase that follows the name of the work ("took more than ..."); empty if there is one.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

  // Written by a process that may have malfunctioned: the caller must validate all of it.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  friend ChildResult run_guarded(const ChildLimits& limits, const std::function<void(ChildAnswer&)>& work);

  void* mapping_ = nullptr;
  std::size_t mapped_bytes_ = 0;
  std::span<const std::byte> bytes_;
  std::string trouble_;
};

// Thread-safe. Leaves no process and no descriptor behind. `work` runs in the child only: its changes are not visible to the
// caller. It must not use locks that other threads may hold, write to streams or start threads. It may allocate memory (new,
// malloc) and throw; an exception is reported by trouble().
ChildResult run_guarded(const ChildLimits& limits, const std::function<void(ChildAnswer&)>& work);

// False in builds with sanitizers: their allocators abort the child instead of throwing, so that trouble() reports only that it
// ended.
bool tells_of_memory();

}  // namespace fdcg::bake
