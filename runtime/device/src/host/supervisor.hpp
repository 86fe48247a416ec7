// SPDX-License-Identifier: Apache-2.0
// The thread that opens devices, closes a lost one when no thread is inside, and reopens it when it is back.
// All calls that enumerate, open or close are made here, one device after another: hidapi needs one thread for them, and they
// take milliseconds.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/threads.hpp"
#include "host/emergency.hpp"
#include "host/servo_loop.hpp"
#include "host/writer.hpp"
#include "tick/link.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

struct SupervisedDevice {
  Transport* transport = nullptr;
  Link* link = nullptr;
  ServoLoop* servo = nullptr;
  Writer* writer = nullptr;
  EmergencyExit* emergency = nullptr;  // what the transport has, while it is open
};

class Supervisor {
 public:
  // Before the thread runs. What they point to must outlive it.
  void add(const SupervisedDevice& device);

  // The thread's body, until request_stop. It leaves open what is open.
  void run();
  void request_stop();
  Event& lost() { return wake_; }  // for ServoParts

  // Any thread's. Why the last attempt to open failed; empty: it did not.
  std::string problem(int device) const;
  bool is_over(int device) const;

 private:
  enum class State : std::uint8_t { kAbsent, kOpen, kClosing, kOver };
  struct Watched {
    SupervisedDevice parts;
    State state = State::kAbsent;
    std::uint64_t opened_ns = 0, absent_since_ns = 0, next_try_ns = 0;
    std::atomic<bool> is_over{false};
    std::string problem;  // under problem_mutex_
  };
  void look_after(Watched& device);
  void try_to_open(Watched& device, std::uint64_t now_ns);
  void begin_closing(Watched& device);
  void try_to_close(Watched& device, std::uint64_t now_ns);

  std::vector<std::unique_ptr<Watched>> devices_;
  Event wake_;
  std::atomic<bool> is_stopping_{false};
  mutable std::mutex problem_mutex_;
};

}  // namespace fdcg::dev
