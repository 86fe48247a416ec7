// SPDX-License-Identifier: Apache-2.0
// What the host needs of the system's threads: a clock, an event that one thread waits for, and a thread that can be joined
// with a time limit. threads_posix.cpp implements it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace fdcg::dev {

std::uint64_t monotonic_ns();
// For which the computer has been suspended since it was started, and what this call takes. now_ns: monotonic, just read.
std::uint64_t slept_ns(std::uint64_t now_ns);

// A signal is kept until a wait takes it; several before it are one. One thread waits, any number signal. No lock, no heap.
class Event {
 public:
  void signal() noexcept;                        // async-signal-safe
  bool wait(std::uint64_t timeout_ns) noexcept;  // true: signalled; false: the time has run out

 private:
  std::atomic<std::uint32_t> word_{0};
};

struct ThreadState;

// Every signal but those of a crash is blocked in such a thread, so that no blocking read of a device ends early; it has a
// stack of its own for the handler of a crash.
class Thread {
 public:
  // Empty: it runs. `name`: at most 15 characters. The body must not throw; what it captures lives until it returns.
  std::string start(const char* name, std::function<void()> body);
  // False: it still runs. A thread that was not started counts as ended.
  bool join_within(std::uint64_t timeout_ns);
  // Detaches it: it may run until the process ends.
  void abandon();
  bool is_started() const { return state_ != nullptr; }
  std::uintptr_t handle() const;  // the system's

 private:
  std::shared_ptr<ThreadState> state_;
};

}  // namespace fdcg::dev
