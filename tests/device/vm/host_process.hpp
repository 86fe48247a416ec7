// SPDX-License-Identifier: Apache-2.0
// `fdcg-servo run` as a child process: commands to its standard input, its status from its standard output.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace fdcg::vm {

class HostProcess {
 public:
  HostProcess() = default;
  ~HostProcess();  // kills
  HostProcess(const HostProcess&) = delete;
  HostProcess& operator=(const HostProcess&) = delete;

  // preload: a library for it, or null.
  void start(const std::vector<std::string>& command, const char* preload);
  void say(const std::string& line);  // to its standard input
  void signal(int number);
  bool is_running() const { return pid_ > 0; }
  pid_t pid() const { return pid_; }
  // How it ended: its exit code, or 128 + the signal.
  int ending() const { return ending_; }

  // To be polled for reading; receive() then reads what is there and notices its end. -1: not running.
  int fd() const { return output_; }
  void receive();

  // The newest status line, null before there was one; how many there were; what else the host said, newest last.
  const std::string& status_line() const { return status_line_; }
  std::uint64_t status_count() const { return status_count_; }
  const std::deque<std::string>& words() const { return words_; }
  int calmings() const { return calmings_; }  // how often it said that it shakes

 private:
  void take_line(const std::string& line);

  pid_t pid_ = -1;
  int input_ = -1, output_ = -1, ending_ = 0;
  std::string partial_;
  std::string status_line_ = "null";
  std::uint64_t status_count_ = 0;
  std::deque<std::string> words_;
  int calmings_ = 0;
};

// A counter of the first device in a status line: "late", "rejected/crc". Throws where there is none. Reading a line takes
// longer than a tick of the device.
std::uint64_t count_of(const std::string& status_line, const std::string& name);
// How often the first device was disarmed for this reason.
std::uint64_t count_of_reason(const std::string& status_line, const std::string& reason);

}  // namespace fdcg::vm
