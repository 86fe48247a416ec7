// SPDX-License-Identifier: Apache-2.0
// A thread of the host that hangs where it is, as a debugger or a fault of the system may leave it: the other threads take the
// force away.
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "catch.hpp"
#include "hosted.hpp"

using namespace fdcg::dev;
using namespace fdcg::dev::test;

namespace {

// How often each is done: so often, or as FDCG_STRIKES says.
int strikes(int standard) {
  const char* const wanted = std::getenv("FDCG_STRIKES");
  return wanted != nullptr ? std::atoi(wanted) : standard;
}

std::atomic<bool> is_held{false};

void hold(int) {
  const timespec pause{0, 100'000};
  while (is_held.load())
    nanosleep(&pause, nullptr);
}

// Of this process, by its name; 0: none.
int thread_named(const std::string& name) {
  int found = 0;
  DIR* const folder = opendir("/proc/self/task");
  REQUIRE(folder != nullptr);
  while (const dirent* const entry = readdir(folder)) {
    std::string text;
    std::ifstream(std::string("/proc/self/task/") + entry->d_name + "/comm") >> text;
    if (text == name) found = std::atoi(entry->d_name);
  }
  closedir(folder);
  return found;
}

// A crash signal is the one kind that these threads do not block.
class Hold {
 public:
  explicit Hold(const std::string& name) {
    struct sigaction action {};
    action.sa_handler = hold;
    sigaction(SIGTRAP, &action, &before_);
    is_held = true;
    const int thread = thread_named(name);
    REQUIRE(thread != 0);
    REQUIRE(syscall(SYS_tgkill, getpid(), thread, SIGTRAP) == 0);
  }
  ~Hold() {
    is_held = false;
    sleep_ms(5);
    sigaction(SIGTRAP, &before_, nullptr);
  }

 private:
  struct sigaction before_ {};
};

}  // namespace

TEST_CASE("host: a servo thread that hangs leaves no force, and comes back disarmed") {
  for (int round = 0; round < strikes(5); ++round) {
    Hosted hosted;
    hosted.start();
    hosted.press();
    {
      const Hold held("fdcg-servo");
      CHECK(within_ms(1000, [&] { return hosted.device().force_n == 0; }));
      sleep_ms(30);
      CHECK(hosted.device().force_n == 0);
      CHECK(within_ms(1000, [&] { return hosted.phase() == Phase::kDisarmed; }));  // as it is told
      CHECK(hosted.fault() == Fault::kHostLate);
    }
    CHECK(within_ms(1000, [&] { return hosted.phase() == Phase::kDisarmed; }));
    CHECK(hosted.fault() == Fault::kHostLate);
    CHECK(hosted.host.stop() == "");
  }
}

namespace {

// One time; false: this machine was too busy to say.
bool holds_a_writer() {
  Hosted hosted;
  int ends[2];
  REQUIRE(pipe2(ends, O_NONBLOCK | O_DIRECT) == 0);  // one report at a time: on a busy machine there may be an earlier zero
  hosted.device().emergency = ends[1];
  hosted.start();
  hosted.press();
  ssize_t bytes = -1;
  std::uint8_t report[kMaxReportBytes];
  Fault fault{};
  {
    const Hold held("fdcg-writer");
    REQUIRE(within_ms(1000, [&] { return hosted.phase() == Phase::kDisarmed; }));
    fault = hosted.fault();
    within_ms(fault == Fault::kWriterStuck ? 5000 : 0, [&] { return (bytes = read(ends[0], report, sizeof report)) > 0; });
  }
  CHECK(within_ms(1000, [&] { return hosted.device().force_n == 0; }));
  hosted.device().emergency = -1;
  CHECK(hosted.host.stop() == "");
  close(ends[0]);
  close(ends[1]);
  if (fault != Fault::kWriterStuck) return false;
  REQUIRE(bytes > 0);
  Command zero;
  REQUIRE(decode_output(fake_profile(), report, static_cast<int>(bytes), &zero));
  CHECK_FALSE(zero.is_enabled);
  CHECK(zero.effort[2] == 0);
  return true;
}

}  // namespace

namespace {

// A pipe that takes nothing any more: who writes there waits.
int full_pipe(int* reading_end) {
  int ends[2];
  REQUIRE(pipe2(ends, O_NONBLOCK) == 0);
  const char bytes[4096] = {};
  while (write(ends[1], bytes, sizeof bytes) > 0) {
  }
  REQUIRE(fcntl(ends[1], F_SETFL, 0) == 0);
  *reading_end = ends[0];
  return ends[1];
}

// False: this machine was too busy to say.
bool is_stuck(Hosted& hosted, int index) {
  hosted.press(index);
  hosted.device(index).holds_writes = true;
  REQUIRE(within_ms(2000, [&] { return hosted.phase(index) == Phase::kDisarmed; }));
  if (hosted.fault(index) == Fault::kWriterStuck) return true;
  hosted.device(index).holds_writes = false;
  return false;
}

}  // namespace

TEST_CASE("host: a device that takes no output in any way does not keep another's zero from being sent") {
  Hosted hosted(2);
  int first_reading = -1, ends[2];
  const int first_writing = full_pipe(&first_reading);
  REQUIRE(pipe2(ends, O_NONBLOCK | O_DIRECT) == 0);
  hosted.device(0).emergency = first_writing;
  hosted.device(1).emergency = ends[1];
  hosted.start();
  for (int index = 0; index < 2; ++index) {
    int tries = 0;
    while (!is_stuck(hosted, index) && ++tries < 6) {
    }
    REQUIRE(tries < 6);
    sleep_ms(50);  // the first one's zero waits in its pipe by now
  }
  std::uint8_t report[kMaxReportBytes];
  ssize_t bytes = -1;
  CHECK(within_ms(2000, [&] { return (bytes = read(ends[0], report, sizeof report)) > 0; }));
  Command zero;
  CHECK(decode_output(fake_profile(), report, static_cast<int>(bytes), &zero));
  CHECK_FALSE(zero.is_enabled);
  std::uint8_t rest[4096];
  while (read(first_reading, rest, sizeof rest) > 0) {
  }
  for (int index = 0; index < 2; ++index)
    hosted.device(index).holds_writes = false;
  CHECK(within_ms(1000, [&] { return hosted.device(0).force_n == 0 && hosted.device(1).force_n == 0; }));
  for (int index = 0; index < 2; ++index)
    hosted.device(index).emergency = -1;
  CHECK(hosted.host.stop() == "");
  for (const int end : {first_reading, first_writing, ends[0], ends[1]})
    close(end);
}

TEST_CASE("host: a writer thread that hangs is disarmed, and another thread sends the zero") {
  int held = 0;
  const int wanted = strikes(5);
  for (int round = 0; round < 6 * wanted && held < wanted; ++round)
    held += holds_a_writer();
  CHECK(held == wanted);
}
