// SPDX-License-Identifier: Apache-2.0
// The loop that lets the device tick and listens to the kernel and to the host program, on one thread. Whatever a scenario does
// to either, it does between two calls of run_*.
#pragma once

#include <functional>
#include <random>

#include "device.hpp"
#include "host_process.hpp"
#include "verdicts.hpp"

namespace fdcg::vm {

struct RigOptions {
  bool is_usb = false;
  std::string backend = "hidraw";  // of hidapi
  int rate_hz = 1000;
  bool has_float_axes = false;
  bool has_log = false;
  bool is_log_small = false;    // the log stands on a disk of its own that is soon full
  bool has_clock_shim = false;  // of the host: add_to_boot_clock moves its clock
  bool has_watchdog = true;     // of the device
  bool is_timed = true;         // false: two processors, where no time is judged
  std::uint64_t seed = 1;
};

class Rig {
 public:
  using Condition = std::function<bool()>;

  explicit Rig(const RigOptions& options);
  ~Rig();
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  void run_until(Nanoseconds moment);
  void run_for(Nanoseconds duration) { run_until(now_ns() + duration); }
  // False: the condition has not come true within the limit.
  bool run_until(const Condition& condition, Nanoseconds limit);

  void start_host();
  void start_second_host(const std::vector<std::string>& command) { second.start(command, nullptr); }
  // False: no report has been answered within the limit.
  bool is_answered_again(Nanoseconds limit = 5 * kSecond);
  // True when it has gone on request within the limit (6 s of the host's own, and some).
  bool end_host();
  // Takes the tip out of the surface, asks for force, puts the tip in. False: no force within the limit.
  bool feel();
  Nanoseconds period() const { return kSecond / options.rate_hz; }
  Nanoseconds random_between(Nanoseconds least, Nanoseconds most);
  bool host_says_log_failed();
  // A status that was written from now on has come.
  bool refresh_status(Nanoseconds limit = kSecond);
  void say_host_words(Verdicts& verdicts) const;

  const RigOptions options;
  Device device;
  HostProcess host, second;           // second: another of the same device
  std::uint64_t missed_ticks = 0;     // of the device's own timer
  std::uint64_t late_ticks = 0;       // of them by more than a quarter of a period
  Nanoseconds longest_reopening = 0;  // from a plug to the first report answered

 private:
  int ticker_ = -1, alarm_ = -1;
  std::mt19937_64 random_;
};

}  // namespace fdcg::vm
