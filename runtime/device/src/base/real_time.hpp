// SPDX-License-Identifier: Apache-2.0
// Real-time settings of threads, as far as the system allows. Each returns an empty string, or what was not granted and what to
// do about it: the host then runs without it, with worse timing.
#pragma once

#include <string>

#include "base/threads.hpp"

namespace fdcg::dev {

// SCHED_FIFO at a priority of 1 to 99. 0: left as it is.
std::string set_real_time_priority(const Thread& thread, const std::string& name, int priority);
// On one cpu. -1: left as it is.
std::string set_cpu(const Thread& thread, const std::string& name, int cpu);
// Locks all pages of the process in memory: present ones, and where there is no limit future ones too.
std::string lock_memory();

// While it lives, the calling thread has that SCHED_FIFO priority, and so have the threads that it starts. 0, or not granted:
// nothing changes.
class OwnPriority {
 public:
  explicit OwnPriority(int priority);
  ~OwnPriority();
  OwnPriority(const OwnPriority&) = delete;
  OwnPriority& operator=(const OwnPriority&) = delete;

 private:
  bool is_changed_ = false;
  int policy_before_ = 0, priority_before_ = 0;
};

// For the calling thread, at its start: touches the stack that it will use, requests timers without slack.
void prepare_servo_thread();

}  // namespace fdcg::dev
