// SPDX-License-Identifier: Apache-2.0
// The guarded child: limits on memory and time, isolation of crashes, no leaked resources.
#include <dirent.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "import/guarded_child.hpp"

using namespace fdcg::bake;

namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20;
constexpr ChildLimits kLimits = {64 * kMebibyte, kMebibyte, 10};

void say(ChildAnswer& answer, const std::string& text) {
  const std::span<std::byte> place = answer.append(text.size());
  std::memcpy(place.data(), text.data(), text.size());
}

std::string text_of(const ChildResult& result) {
  return {reinterpret_cast<const char*>(result.bytes().data()), result.bytes().size()};
}

std::size_t open_descriptors() {
  std::size_t count = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  if (folder == nullptr) return 0;
  while (::readdir(folder) != nullptr)
    ++count;
  ::closedir(folder);
  return count;
}

bool has_children() {
  return ::waitpid(-1, nullptr, WNOHANG) != -1 || errno != ECHILD;
}

std::atomic<int> signals_seen{0};
extern "C" void count_signal(int) {
  ++signals_seen;
}

}  // namespace

TEST_CASE("guarded child: the result is returned, other effects stay in the child") {
  int changed = 0;
  const ChildResult result = run_guarded(kLimits, [&changed](ChildAnswer& answer) {
    changed = 1;
    say(answer, "eight by");
    say(answer, "te");
  });
  CHECK(result.trouble().empty());
  CHECK(text_of(result) == "eight byte" + std::string(6, '\0'));  // each piece starts at a multiple of 8
  CHECK(changed == 0);
  CHECK_FALSE(has_children());
}

TEST_CASE("guarded child: the memory limit is enforced") {
  const ChildResult result = run_guarded(kLimits, [](ChildAnswer& answer) {
    std::vector<char> much(std::size_t{16} << 30, 'x');
    say(answer, std::string(1, much[much.size() / 2]));
  });
  const bool tells = tells_of_memory();
  CHECK(result.trouble() ==
        (tells ? "took more than the 64 MiB of memory that a file of this size is given" : "ended without an answer"));
  const ChildResult bit_by_bit = run_guarded(kLimits, [](ChildAnswer& answer) {
    std::vector<std::string> pieces;
    for (;;)
      pieces.emplace_back(100'000, 'x');
    say(answer, pieces[0]);
  });
  CHECK(bit_by_bit.trouble() == result.trouble());
  // Its allowance does not depend on the memory used by this process.
  const std::vector<char> ours(256 * kMebibyte, 'y');
  const ChildResult fits = run_guarded(kLimits, [&ours](ChildAnswer& answer) {
    const std::vector<char> some(48 * kMebibyte, 'x');
    say(answer, std::string(1, some[ours.size() / 16]));
  });
  CHECK(fits.trouble().empty());
}

TEST_CASE("guarded child: the time limit is enforced") {
  ChildLimits limits = kLimits;
  limits.cpu_seconds = 1;
  const ChildResult result = run_guarded(limits, [](ChildAnswer&) {
    volatile unsigned n = 0;
    for (;;)
      n = n + 1;
  });
  CHECK(result.trouble() == "took more than the 1 s of processor time that a file of this size is given");
}

TEST_CASE("guarded child: crash, exit and exception are reported") {
  const auto trouble = [](const std::function<void(ChildAnswer&)>& work) { return run_guarded(kLimits, work).trouble(); };
  CHECK(trouble([](ChildAnswer&) { ::raise(SIGSEGV); }) == "crashed with signal 11");
  CHECK(trouble([](ChildAnswer&) { std::abort(); }) == "crashed with signal 6");
  CHECK(trouble([](ChildAnswer&) { ::raise(SIGKILL); }) == "was killed, perhaps because the machine ran out of memory");
  CHECK(trouble([](ChildAnswer&) { ::_exit(3); }) == "ended without an answer");
  CHECK(trouble([](ChildAnswer&) { throw std::runtime_error("words"); }) == "failed: words");
  CHECK(trouble([](ChildAnswer&) { throw 7; }) == "failed: unknown exception");
  CHECK(trouble([](ChildAnswer&) { throw std::runtime_error(std::string(1000, 'w')); }) == "failed: " + std::string(95, 'w'));
  CHECK(trouble([](ChildAnswer& answer) { answer.append(2 * kMebibyte); }) ==
        "came to more than the 1 MiB that a file of this size is given");
  CHECK(trouble([](ChildAnswer& answer) { answer.append(~std::size_t{0}); }) ==
        "came to more than the 1 MiB that a file of this size is given");
  CHECK_FALSE(has_children());
}

TEST_CASE("guarded child: signal and exit handlers of the parent do not run") {
  struct sigaction ours {
  }, before{};
  ours.sa_handler = count_signal;
  ::sigaction(SIGSEGV, &ours, &before);
  std::atexit([] { ++signals_seen; });
  const ChildResult result = run_guarded(kLimits, [](ChildAnswer& answer) {
    say(answer, std::to_string(signals_seen.load()));
    ::raise(SIGSEGV);
  });
  ::sigaction(SIGSEGV, &before, nullptr);
  CHECK(result.trouble() == "crashed with signal 11");
  CHECK(signals_seen == 0);
}

TEST_CASE("guarded child: works with interrupting signals and ignored SIGCHLD") {
  struct sigaction ours {
  }, before{};
  ours.sa_handler = count_signal;  // without SA_RESTART: waitpid is interrupted
  ::sigaction(SIGUSR1, &ours, &before);
  const pthread_t self = ::pthread_self();
  std::atomic<bool> is_done{false};
  std::thread disturber([&] {
    while (!is_done) {
      ::pthread_kill(self, SIGUSR1);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  for (int i = 0; i < 20; ++i) {
    const ChildResult result = run_guarded(kLimits, [](ChildAnswer& answer) { say(answer, "here"); });
    CHECK(text_of(result).starts_with("here"));
  }
  is_done = true;
  disturber.join();
  CHECK(signals_seen > 0);
  signals_seen = 0;
  ::sigaction(SIGUSR1, &before, nullptr);

  ::signal(SIGCHLD, SIG_IGN);
  const ChildResult ignored = run_guarded(kLimits, [](ChildAnswer& answer) { say(answer, "here"); });
  CHECK(text_of(ignored).starts_with("here"));
  const ChildResult crashed = run_guarded(kLimits, [](ChildAnswer&) { std::abort(); });
  CHECK(crashed.trouble() == "ended without an answer");
  ::signal(SIGCHLD, SIG_DFL);
}

TEST_CASE("guarded child: thread-safe, and leaves no process or descriptor behind") {
  const std::size_t before = open_descriptors();
  std::atomic<bool> is_done{false};
  std::vector<std::thread> busy, callers;
  for (int t = 0; t < 4; ++t) {
    busy.emplace_back([&is_done] {  // holds malloc's locks at most forks
      std::vector<std::string> strings;
      while (!is_done) {
        strings.emplace_back(1 + strings.size() * 37 % 5000, 'x');
        if (strings.size() > 1000) strings.clear();
      }
    });
  }
  std::atomic<int> right{0};
  constexpr int kThreads = 8, kRuns = 25;
  for (int t = 0; t < kThreads; ++t) {
    callers.emplace_back([&right, t] {
      for (int i = 0; i < kRuns; ++i) {
        const ChildResult result = run_guarded(kLimits, [t, i](ChildAnswer& answer) {
          std::vector<std::string> words;
          for (int k = 0; k < 100; ++k)
            words.push_back(std::string(static_cast<std::size_t>(1 + k * 100), 'a'));
          if (i % 5 == 4) throw std::runtime_error("thrown");
          say(answer, "t" + std::to_string(t));
        });
        right += i % 5 == 4 ? result.trouble() == "failed: thrown" : text_of(result).starts_with("t" + std::to_string(t));
      }
    });
  }
  for (std::thread& caller : callers)
    caller.join();
  is_done = true;
  for (std::thread& thread : busy)
    thread.join();
  CHECK(right == kThreads * kRuns);
  CHECK(open_descriptors() == before);
  CHECK_FALSE(has_children());
}
