// SPDX-License-Identifier: Apache-2.0
// The main loop of fdcg-servo run: commands, arming, what is printed.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/device_tools.hpp"
#include "run_tap.hpp"
#include "signals.hpp"
#include "terminal_keys.hpp"

namespace fdcg::servo {

enum class StatusKind { kText, kJson, kNone };

struct RunArguments {
  std::string scene, log, hid;
  bool no_log = false, arm = false, quiet = false, fast = false, plugins = false;
  TapArguments tap;
  double for_s = 0;           // 0: no end
  double status_every_s = 0;  // 0: the default
  StatusKind status = StatusKind::kText;
};

// One run of a scene whose devices have been started.
class RunSession {
 public:
  // log_file: empty, no log. tap: null, none.
  RunSession(const RunArguments& arguments, dev::SceneRun& host, Signals& signals, std::string log_file, RunTap* tap);
  void run();                                // until a signal, quit, the end of the time or of every device
  int end(const std::string& stop_problem);  // prints the summary; the exit code

 private:
  struct Seen {
    bool is_open = false;
    std::string problem;
    std::uint64_t disarmed[dev::kFaults] = {};
    dev::Phase phase = dev::Phase::kDisarmed;
    double calmed = 0;
    bool is_hot = false;
    bool wants_arming = false;  // --arm: until the gate has granted it once
    bool was_asked = false;     // to arm
    double asked_s = -1;        // when; -1: granted, or its refusal was printed
    std::uint64_t ticks = 0;    // at the last status line
  };

  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count(); }
  bool says_text() const { return arguments_.status == StatusKind::kText && !arguments_.quiet; }
  void obey(const std::string& command);
  void disarm();
  bool has_left_zero(std::size_t device, std::uint64_t* first_zero);
  void stop_disarmed(int signal, TerminalKeys& keys);
  void look();
  void notice(std::size_t device);
  void notice_connection(std::size_t device);
  void notice_stability(std::size_t device);
  void arm_where_wanted(std::size_t device);
  void say(const std::string& line);
  void show_status();
  void wipe();

  const RunArguments& arguments_;
  dev::SceneRun& host_;
  Signals& signals_;
  RunTap* const tap_;
  const std::string log_file_;  // empty: none
  const bool is_terminal_;
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::vector<dev::DeviceLook> looks_;
  std::vector<Seen> seen_;
  std::size_t name_width_ = 0;
  double status_every_s_ = 1, next_status_s_ = 0, last_status_s_ = 0, next_arming_s_ = 0;
  std::string log_failure_;
  std::size_t lines_drawn_ = 0;  // of the status, on a terminal
};

}  // namespace fdcg::servo
