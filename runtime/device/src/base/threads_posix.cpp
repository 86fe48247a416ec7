// SPDX-License-Identifier: Apache-2.0
#include "base/threads.hpp"

#include <linux/futex.h>
#include <pthread.h>
#include <signal.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cstring>
#include <vector>

#include "base/crash_signals.hpp"

namespace fdcg::dev {

namespace {

constexpr std::uint64_t kNsPerS = 1'000'000'000;
constexpr std::uint32_t kIdle = 0, kSignalled = 1, kWaiting = 2;
constexpr std::size_t kStackBytes =
    1024 * 1024;  // the step needs some 20 KB, a sanitizer half a MB; all of it is locked in memory
constexpr std::size_t kCrashStackBytes = 64 * 1024;

static_assert(std::atomic<std::uint32_t>::is_always_lock_free && sizeof(std::atomic<std::uint32_t>) == 4, "the kernel's futex");

std::uint64_t now_of(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * kNsPerS + static_cast<std::uint64_t>(now.tv_nsec);
}

}  // namespace

std::uint64_t monotonic_ns() {
  return now_of(CLOCK_MONOTONIC);
}

// What the one clock has counted and the other has not; without such a clock a suspended machine shows as a late host.
std::uint64_t slept_ns(std::uint64_t now_ns) {
#ifdef CLOCK_BOOTTIME
  const std::uint64_t all_ns = now_of(CLOCK_BOOTTIME);
  return all_ns > now_ns ? all_ns - now_ns : 0;
#else
  (void)now_ns;
  return 0;
#endif
}

void Event::signal() noexcept {
  if (word_.exchange(kSignalled, std::memory_order_acq_rel) != kWaiting) return;
  syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word_), FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

bool Event::wait(std::uint64_t timeout_ns) noexcept {
  std::uint32_t was = kIdle;
  if (!word_.compare_exchange_strong(was, kWaiting, std::memory_order_acq_rel)) {
    word_.exchange(kIdle, std::memory_order_acq_rel);  // only this thread clears a signal
    return true;
  }
  const std::uint64_t until_ns = monotonic_ns() + timeout_ns;
  const timespec until{static_cast<time_t>(until_ns / kNsPerS), static_cast<long>(until_ns % kNsPerS)};
  while (word_.load(std::memory_order_acquire) == kWaiting && monotonic_ns() < until_ns) {
    syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word_), FUTEX_WAIT_BITSET_PRIVATE, kWaiting, &until, nullptr,
            FUTEX_BITSET_MATCH_ANY);
  }
  return word_.exchange(kIdle, std::memory_order_acq_rel) == kSignalled;
}

struct ThreadState {
  std::function<void()> body;
  std::vector<char> crash_stack;
  std::atomic<bool> has_ended{false};
  Event ended;
  pthread_t thread = {};
};

namespace {

void run_body(ThreadState& state) {
  stack_t own{}, before{};
  own.ss_sp = state.crash_stack.data();
  own.ss_size = state.crash_stack.size();
  const bool has_own = sigaltstack(&own, &before) == 0;
  state.body();
  state.body = nullptr;
  if (has_own) sigaltstack(&before, nullptr);  // a sanitizer frees what it finds there
  state.has_ended.store(true, std::memory_order_release);
  state.ended.signal();
}

// The thread has its own share of the state: it may outlive the Thread that started it.
extern "C" void* fdcg_run_thread(void* share) {
  const std::unique_ptr<std::shared_ptr<ThreadState>> state(static_cast<std::shared_ptr<ThreadState>*>(share));
  run_body(**state);
  return nullptr;
}

}  // namespace

std::string Thread::start(const char* name, std::function<void()> body) {
  state_ = std::make_shared<ThreadState>();
  state_->body = std::move(body);
  state_->crash_stack.resize(kCrashStackBytes);
  auto share = std::make_unique<std::shared_ptr<ThreadState>>(state_);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  sigset_t all, before;
  sigfillset(&all);
  for (const int signal : kCrashSignals)
    sigdelset(&all, signal);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const int failure = pthread_create(&state_->thread, &attributes, fdcg_run_thread, share.get());
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_attr_destroy(&attributes);
  if (failure != 0) {
    state_ = nullptr;
    return std::string("the thread '") + name + "' cannot be started: " + std::strerror(failure);
  }
  share.release();  // the thread's now
  pthread_setname_np(state_->thread, name);
  return {};
}

bool Thread::join_within(std::uint64_t timeout_ns) {
  if (!state_) return true;
  const std::uint64_t until_ns = monotonic_ns() + timeout_ns;
  while (!state_->has_ended.load(std::memory_order_acquire)) {
    const std::uint64_t now_ns = monotonic_ns();
    if (now_ns >= until_ns) return false;
    state_->ended.wait(until_ns - now_ns);
  }
  pthread_join(state_->thread, nullptr);
  state_ = nullptr;
  return true;
}

void Thread::abandon() {
  if (!state_) return;
  pthread_detach(state_->thread);
  state_ = nullptr;
}

std::uintptr_t Thread::handle() const {
  return state_ ? static_cast<std::uintptr_t>(state_->thread) : 0;
}

}  // namespace fdcg::dev
