// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/real_time.hpp"

namespace fdcg::dev {

namespace {

constexpr std::size_t kStackTouchBytes = 64 * 1024;
constexpr std::size_t kPageBytes = 4096;

std::string limit_text(int resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return "unknown";
  return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur);
}

}  // namespace

std::string set_real_time_priority(const Thread& thread, const std::string& name, int priority) {
  if (priority == 0 || !thread.is_started()) return {};
  sched_param wanted{};
  wanted.sched_priority = priority;
  const int failure = pthread_setschedparam(static_cast<pthread_t>(thread.handle()), SCHED_FIFO, &wanted);
  if (failure == 0) return {};
  const std::string what = name + ": no real-time priority " + std::to_string(priority) + " (SCHED_FIFO): ";
  if (failure != EPERM) return what + std::strerror(failure);
  return what + "the limit rtprio is " + limit_text(RLIMIT_RTPRIO) +
         "; put the line '@realtime - rtprio 95' into /etc/security/limits.d/fdcg.conf, join the group 'realtime' and log in"
         " again, or give the program CAP_SYS_NICE";
}

std::string set_cpu(const Thread& thread, const std::string& name, int cpu) {
  if (cpu < 0 || !thread.is_started()) return {};
  const long present = sysconf(_SC_NPROCESSORS_CONF);
  int failure = EINVAL;
  if (cpu < CPU_SETSIZE && cpu < present) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET(static_cast<std::size_t>(cpu), &cpus);
    failure = pthread_setaffinity_np(static_cast<pthread_t>(thread.handle()), sizeof cpus, &cpus);
  }
  if (failure == 0) return {};
  return name + ": not on cpu " + std::to_string(cpu) + " (this machine has 0 to " + std::to_string(present - 1) +
         "): " + std::strerror(failure);
}

std::string lock_memory() {
  rlimit limit{};
  const bool is_unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  // Future pages would count against the limit too: where there is one, a later allocation could fail.
  const bool may_lock_future = is_unlimited || geteuid() == 0;
  if (mlockall(may_lock_future ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0) return {};
  return std::string("memory is not locked: ") + std::strerror(errno) + "; the limit memlock is " + limit_text(RLIMIT_MEMLOCK) +
         " bytes; put the line '@realtime - memlock unlimited' into /etc/security/limits.d/fdcg.conf, join the group 'realtime'"
         " and log in again, or give the program CAP_IPC_LOCK";
}

OwnPriority::OwnPriority(int priority) {
  sched_param before{}, wanted{};
  wanted.sched_priority = priority;
  if (priority == 0 || pthread_getschedparam(pthread_self(), &policy_before_, &before) != 0) return;
  priority_before_ = before.sched_priority;
  is_changed_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
}

OwnPriority::~OwnPriority() {
  sched_param before{};
  before.sched_priority = priority_before_;
  if (is_changed_) pthread_setschedparam(pthread_self(), policy_before_, &before);
}

void prepare_servo_thread() {
  volatile char stack[kStackTouchBytes];
  for (std::size_t i = 0; i < sizeof stack; i += kPageBytes)
    stack[i] = 0;
  prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);  // ns; ordinary threads wake up to 50 us late otherwise
}

}  // namespace fdcg::dev
