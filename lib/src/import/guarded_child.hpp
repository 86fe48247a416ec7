// SPDX-License-Identifier: Apache-2.0
// Runs a piece of work in a child process, under limits of memory and time, and brings back the bytes that it answers. For
// libraries that a forged file can make crash, loop or take all memory. guarded_child_posix.cpp is the POSIX side.
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

// What the child answers with. Lives in the child.
class ChildAnswer {
 public:
  // Space for the next `bytes` of the answer, at a multiple of 8, zeroed. Throws beyond ChildLimits::answer_bytes: let it pass.
  virtual std::span<std::byte> append(std::size_t bytes) = 0;

 protected:
  ~ChildAnswer() = default;
};

// The child's answer, mapped: nothing is copied.
class ChildResult {
 public:
  ChildResult() = default;
  ChildResult(ChildResult&& other) noexcept;
  ChildResult& operator=(ChildResult&& other) noexcept;
  ChildResult(const ChildResult&) = delete;
  ChildResult& operator=(const ChildResult&) = delete;
  ~ChildResult();

  // Why there is no answer, in words that follow the name of what was run: "took more than ..."; empty where there is one.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

  // Written by a process that may have gone wrong: check everything.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  friend ChildResult run_guarded(const ChildLimits& limits, const std::function<void(ChildAnswer&)>& work);

  void* mapping_ = nullptr;
  std::size_t mapped_bytes_ = 0;
  std::span<const std::byte> bytes_;
  std::string trouble_;
};

// May be called from several threads at once, whatever other threads do. Leaves no process and no descriptor behind. `work`
// runs in the child alone: what it changes is not seen here, and it must neither touch locks that other threads might have
// held, nor write to streams, nor start threads. Memory (new, malloc) and exceptions are free to it; what it throws is trouble.
ChildResult run_guarded(const ChildLimits& limits, const std::function<void(ChildAnswer&)>& work);

// False in builds with sanitizers: their allocators end the child where others throw, so that trouble() is only that it ended.
bool tells_of_memory();

}  // namespace fdcg::bake
