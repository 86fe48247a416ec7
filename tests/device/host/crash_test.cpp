// SPDX-License-Identifier: Apache-2.0
// What is left behind by a process that crashes while it drives a device.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <thread>

#include "host/emergency.hpp"
#include "hosted.hpp"

using namespace fdcg::dev;
using namespace fdcg::dev::test;

namespace {

// Ways to crash.
void overflow_stack(volatile char* outer) {
  volatile char inner[4096];
  inner[0] = *outer;
  if (inner[0] != 0) overflow_stack(inner);
  *outer = inner[0];  // no tail call
}
void crash_in_four_threads() {
  std::atomic<int> ready{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&ready] {
      for (++ready; ready < 4;)
        continue;
      raise(SIGSEGV);
    });
  }
  for (std::thread& thread : threads)
    thread.join();
}

// In a process of its own: crashes with a force on. The descriptor stands for a hidraw node.
void crash_with_force(int descriptor, const std::function<void()>& crash) try {
  for (const int one : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGUSR1})
    signal(one, SIG_DFL);  // the test framework has its own
  stack_t none{};
  none.ss_flags = SS_DISABLE;
  sigaltstack(&none, nullptr);    // and a stack
  std::atexit([] { _exit(7); });  // after the handlers': what follows is the test framework's
  const rlimit no_core{};
  setrlimit(RLIMIT_CORE, &no_core);
  Hosted hosted;
  hosted.device().emergency = descriptor;
  install_crash_handlers();
  hosted.start();
  hosted.press();
  crash();
} catch (...) {  // a check that failed
  _exit(3);
}

// What a process that crashes so sends, and how it ends.
std::vector<std::uint8_t> reports_after_crash(const std::function<void()>& crash, int* status) {
  static_cast<void>(cube_file());
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    close(ends[0]);
    crash_with_force(ends[1], crash);
    _exit(0);
  }
  close(ends[1]);
  std::vector<std::uint8_t> data;
  std::uint8_t some[256];
  for (ssize_t n = 0; (n = read(ends[0], some, sizeof some)) > 0;)
    data.insert(data.end(), some, some + n);
  close(ends[0]);
  REQUIRE(waitpid(child, status, 0) == child);
  return data;
}

// Zero force, twice where the writer was sending meanwhile, then the safe stop.
void check_reports(const std::vector<std::uint8_t>& data) {
  const Profile profile = fake_profile();
  const auto bytes = static_cast<std::size_t>(profile.output.bytes), stop_bytes = std::size_t{profile.safe_stop[0].bytes};
  // before them one for each time that the writer of a busy machine was not run for 5 ms
  REQUIRE(data.size() >= bytes + stop_bytes);
  REQUIRE((data.size() - stop_bytes) % bytes == 0);
  std::uint32_t sequence = 100;  // goes on from the writer's, so that the device takes it
  for (std::size_t at = 0; at + stop_bytes < data.size(); at += bytes) {
    Command command;
    REQUIRE(decode_output(profile, data.data() + at, profile.output.bytes, &command));
    CHECK(command.effort[2] == 0);
    CHECK_FALSE(command.is_enabled);
    CHECK(command.sequence > sequence);
    sequence = command.sequence;
  }
  CHECK(data[data.size() - stop_bytes] == 9);
}

void check_reports_after_crash(const std::function<void()>& crash, int number) {
  int status = 0;
  check_reports(reports_after_crash(crash, &status));
  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == number);
}

}  // namespace

TEST_CASE("crash handler: sends zero force and the safe stop, then the process ends by its signal") {
  for (const int crash : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGUSR1})
    check_reports_after_crash([crash] { raise(crash); }, crash);
}

TEST_CASE("crash handler: who calls exit() with a device open leaves zero force and the safe stop") {
  for (const bool is_of_main : {true, false}) {
    int status = 0;
    check_reports(
        reports_after_crash([is_of_main] { is_of_main ? std::exit(1) : std::thread([] { std::exit(1); }).join(); }, &status));
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 7);
  }
}

TEST_CASE("crash handler: stack overflow and simultaneous crashes leave zero force") {
  check_reports_after_crash(
      [] {
        volatile char more = 1;
        overflow_stack(&more);
      },
      SIGSEGV);
  for (int round = 0; round < 10; ++round)
    check_reports_after_crash(crash_in_four_threads, SIGSEGV);
}
