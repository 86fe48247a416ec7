// SPDX-License-Identifier: Apache-2.0
// Uses fork, with the result in shared memory, so that there is no descriptor to leak and no pipe to fill.
//
// The other threads of the process do not exist in the child: a lock that one of them held at the fork stays locked there
// forever. The child is safe nevertheless. The fork of glibc (and of musl from 1.2.2) leaves the locks of malloc usable; GCC's
// unwinder, from 12 on with glibc 2.35, finds frames without a lock; and `work` must not use other locks (guarded_child.hpp).
// The child ends by _exit: no exit handler runs twice, no stream is flushed twice. If it blocks in a lock after all, its alarm
// ends it.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "import/guarded_child.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FDCG_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define FDCG_SANITIZED 1
#endif
#endif
#ifndef FDCG_SANITIZED
#define FDCG_SANITIZED 0
#endif

namespace fdcg::bake {
namespace {

constexpr std::size_t kAlign = 8;
constexpr unsigned kClockPerCpu = 20;     // a busy machine gives a process a small share
constexpr unsigned kClockSeconds = 60;    // and may be slow to start it
constexpr std::size_t kMostTrouble = 96;  // bytes of an exception's text that are kept

enum class State : std::uint32_t { running, answered, no_memory, too_long, threw };

// At the start of the shared mapping; the answer follows.
struct Shared {
  std::atomic<State> state{State::running};
  std::array<char, kMostTrouble> trouble{};  // of State::threw
  std::uint64_t used = 0;                    // bytes of the answer
};
static_assert(sizeof(Shared) % kAlign == 0 && std::atomic<State>::is_always_lock_free);

struct AnswerTooLong {};

class SharedAnswer final : public ChildAnswer {
 public:
  SharedAnswer(Shared& shared, std::size_t capacity)
      : shared_(shared), first_(reinterpret_cast<std::byte*>(&shared + 1)), capacity_(capacity) {}

  std::span<std::byte> append(std::size_t bytes) override {
    const std::size_t padded = (bytes + kAlign - 1) / kAlign * kAlign;
    if (padded < bytes || padded > capacity_ - shared_.used) throw AnswerTooLong();
    std::byte* place = first_ + shared_.used;
    shared_.used += padded;
    return {place, bytes};
  }

 private:
  Shared& shared_;
  std::byte* first_;
  std::size_t capacity_;
};

#ifdef __linux__
// Bytes of private writable memory that this process has: what RLIMIT_DATA limits (from Linux 4.7). 0 if unknown.
std::uint64_t private_bytes() {
  const int fd = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (fd < 0) return 0;
  std::array<char, 256> text{};
  const ssize_t got = ::read(fd, text.data(), text.size());
  ::close(fd);
  if (got <= 0) return 0;
  // Pages: total, resident, shared, code, 0, data and stack, 0.
  const char* p = text.data();
  const char* const end = p + got;
  std::uint64_t value = 0;
  for (int field = 0; field < 6; ++field) {
    while (p != end && *p == ' ')
      ++p;
    const auto read = std::from_chars(p, end, value);
    if (read.ec != std::errc()) return 0;
    p = read.ptr;
  }
  return value * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}
#endif

void set_limit(int resource, rlim_t soft, rlim_t hard) {
  struct rlimit old {};
  if (::getrlimit(static_cast<decltype(RLIMIT_CPU)>(resource), &old) != 0) return;
  if (old.rlim_max != RLIM_INFINITY) {  // never above what the user allows
    hard = std::min(hard, old.rlim_max);
    soft = std::min(soft, hard);
  }
  const struct rlimit wanted { soft, hard };
  (void)::setrlimit(static_cast<decltype(RLIMIT_CPU)>(resource), &wanted);
}

// Signals must only end the child: the handlers of this program (which remove unfinished files, for example) must not run in
// it.
void forget_signal_handlers() {
  struct sigaction by_default {};
  by_default.sa_handler = SIG_DFL;
  for (int number = 1; number < NSIG; ++number) {
    if (number != SIGKILL && number != SIGSTOP) (void)::sigaction(number, &by_default, nullptr);
  }
  sigset_t none;
  sigemptyset(&none);
  (void)::pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

// A crash inside the library would write its error output into the user's report.
void silence() {
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  (void)::dup2(nowhere, STDOUT_FILENO);
  (void)::dup2(nowhere, STDERR_FILENO);
}

void apply(const ChildLimits& limits, pid_t parent) {
  forget_signal_handlers();
#ifdef __linux__
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);  // the parent has ended, the result is not needed
#endif
  if (::getppid() != parent) ::_exit(1);
  set_limit(RLIMIT_CORE, 0, 0);
  set_limit(RLIMIT_CPU, limits.cpu_seconds, limits.cpu_seconds + 1);
  ::alarm(limits.cpu_seconds * kClockPerCpu + kClockSeconds);
  if (!FDCG_SANITIZED) silence();
#ifdef __linux__
  constexpr std::size_t kOverhead = FDCG_SANITIZED ? 4 : 1;  // red zones, and freed memory held back
  const rlim_t most = private_bytes() + kOverhead * limits.memory_bytes;
  set_limit(RLIMIT_DATA, most, most);
#endif
}

void run_child(Shared& shared, const ChildLimits& limits, const std::function<void(ChildAnswer&)>& work) noexcept {
  try {
    SharedAnswer answer(shared, limits.answer_bytes);
    work(answer);
    shared.state = State::answered;
  } catch (const AnswerTooLong&) {
    shared.state = State::too_long;
  } catch (const std::bad_alloc&) {
    shared.state = State::no_memory;
  } catch (const std::length_error&) {  // thrown by a container resized beyond the address space
    shared.state = State::no_memory;
  } catch (const std::exception& e) {
    std::strncpy(shared.trouble.data(), e.what(), shared.trouble.size() - 1);
    shared.state = State::threw;
  } catch (...) {
    std::strncpy(shared.trouble.data(), "unknown exception", shared.trouble.size() - 1);
    shared.state = State::threw;
  }
}

std::string mebibytes(std::size_t bytes) {
  return std::to_string(bytes >> 20) + " MiB";
}

// `status` is that of waitpid, or -1 if it was not available (for example in a host that ignores SIGCHLD).
std::string trouble_of(const Shared& shared, int status, const ChildLimits& limits) {
  switch (shared.state.load()) {
    case State::answered:
      return {};
    case State::no_memory:
      return "took more than the " + mebibytes(limits.memory_bytes) + " of memory that a file of this size is given";
    case State::too_long:
      return "came to more than the " + mebibytes(limits.answer_bytes) + " that a file of this size is given";
    case State::threw:
      return "failed: " + std::string(shared.trouble.data(), ::strnlen(shared.trouble.data(), shared.trouble.size()));
    case State::running:
      break;
  }
  if (status == -1 || !WIFSIGNALED(status)) return "ended without an answer";
  const int number = WTERMSIG(status);
  if (number == SIGXCPU) {
    return "took more than the " + std::to_string(limits.cpu_seconds) +
           " s of processor time that a file of this size is given";
  }
  if (number == SIGALRM) {
    return "gave no answer within " + std::to_string(limits.cpu_seconds * kClockPerCpu + kClockSeconds) + " s";
  }
  if (number == SIGKILL) return "was killed, perhaps because the machine ran out of memory";
  return "crashed with signal " + std::to_string(number);
}

// fork with all signals blocked, so that no handler of this program runs in the child.
pid_t fork_quietly() {
  sigset_t all, before;
  sigfillset(&all);
  (void)::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t child = ::fork();
  if (child == 0) return child;
  const int error = errno;
  (void)::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return child;
}

}  // namespace

ChildResult run_guarded(const ChildLimits& limits, const std::function<void(ChildAnswer&)>& work) {
  ChildResult result;
  const std::size_t bytes = sizeof(Shared) + limits.answer_bytes;
  void* mapping = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapping == MAP_FAILED) {
    result.trouble_ = "cannot be started: " + std::generic_category().message(errno);
    return result;
  }
  result.mapping_ = mapping;
  result.mapped_bytes_ = bytes;
  Shared& shared = *new (mapping) Shared;

  const pid_t parent = ::getpid(), child = fork_quietly();
  if (child == 0) {
    apply(limits, parent);
    run_child(shared, limits, work);
    ::_exit(0);
  }
  if (child < 0) {
    result.trouble_ = "cannot be started: " + std::generic_category().message(errno);
    return result;
  }
  int status = -1;
  pid_t waited = 0;
  do {
    waited = ::waitpid(child, &status, 0);
  } while (waited < 0 && errno == EINTR);
  result.trouble_ = trouble_of(shared, waited == child ? status : -1, limits);
  if (result.trouble_.empty() && shared.used > limits.answer_bytes) result.trouble_ = "gave an answer of an impossible length";
  if (result.trouble_.empty()) {
    result.bytes_ = {reinterpret_cast<const std::byte*>(&shared + 1), static_cast<std::size_t>(shared.used)};
  }
  return result;
}

bool tells_of_memory() {
  return !FDCG_SANITIZED;
}

ChildResult::ChildResult(ChildResult&& other) noexcept
    : mapping_(std::exchange(other.mapping_, nullptr)),
      mapped_bytes_(std::exchange(other.mapped_bytes_, 0)),
      bytes_(std::exchange(other.bytes_, {})),
      trouble_(std::move(other.trouble_)) {}

ChildResult& ChildResult::operator=(ChildResult&& other) noexcept {
  std::swap(mapping_, other.mapping_);
  std::swap(mapped_bytes_, other.mapped_bytes_);
  std::swap(bytes_, other.bytes_);
  std::swap(trouble_, other.trouble_);
  return *this;
}

ChildResult::~ChildResult() {
  if (mapping_ != nullptr) ::munmap(mapping_, mapped_bytes_);
}

}  // namespace fdcg::bake
