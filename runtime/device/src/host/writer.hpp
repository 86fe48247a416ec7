// SPDX-License-Identifier: Apache-2.0
// A device's writer: a separate thread, since a device that does not take output blocks hid_write for 5 s. It always sends the
// newest force. If nothing new is stored for kSilenceS it sends zero once, so that a hanging servo thread leaves no force; a
// force that old is sent as zero, so that a servo thread that goes on after it hung leaves none either.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/mailbox.hpp"
#include "base/threads.hpp"
#include "host/status.hpp"
#include "profile/profile.hpp"
#include "tick/gate.hpp"
#include "tick/link.hpp"
#include "tick/link_watch.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

inline constexpr std::uint64_t kPublishNs = 20'000'000;  // between two publications of a thread's status

struct WriterStatus {
  std::uint64_t writes = 0, failures = 0;
  TimeHistogram write;  // of a write call
};

class Writer {
 public:
  // All three must outlive it.
  Writer(const Profile& profile, Transport& transport, Link& link);

  // For the servo thread. No lock, no heap, no wait. put stores a force, which the writer sends in its next iteration; wake
  // starts that iteration now (a system call of some microseconds if the thread sleeps). made_ns: the clock of the tick that
  // the force was computed in.
  void put(const GatedForce& force, std::uint32_t echo, std::uint64_t made_ns);
  void wake() { wake_.signal(); }
  // For how long the write in progress has been going on, or the thread has left a stored force where it was; 0: neither.
  std::uint64_t busy_ns(std::uint64_t now_ns);
  bool take_sent(SentReport* sent) { return sent_.take(sent); }  // the newest output report; false: nothing new
  bool has_failed() const { return has_failed_.load(std::memory_order_acquire); }  // the last write

  // The thread's body, until request_stop: then zero force and the profile's safe-stop reports, and out.
  void run();
  void request_stop();
  // After run: false where a device that is there did not take its zero force.
  bool has_left_zero() const { return has_left_zero_.load(std::memory_order_acquire); }

  // For who stands in (stand_in.hpp): 0, or the number of a stall: the thread hangs with a force sent, in a write or between
  // two. A zero force by another way (emergency.hpp) arrives, or waits beside the write that is blocked.
  std::uint64_t stall() const { return stall_.load(std::memory_order_acquire); }
  // The number of a report that somebody else sends in its place; a new one each time.
  std::uint32_t take_sequence() { return sequence_.fetch_add(1); }
  // For the supervisor: waits until the force stored last has been sent, or for that long.
  void flush_within(std::uint64_t timeout_ns);
  void forget_failure() { has_failed_.store(false, std::memory_order_release); }  // the device has been opened anew

  // For crash handlers (emergency.hpp), async-signal-safe: nothing is sent from now on, except a write in progress
  // (is_sending). Returns the sequence number of the next report, a new one each time.
  std::uint32_t mute() {
    is_muted_.store(true);
    return take_sequence();
  }
  bool is_sending() const { return began_ns_.load() != 0; }
  // One thread's at a time. False: nothing new.
  bool take_status(WriterStatus* status) { return status_.take(status); }

 private:
  struct Letter {
    GatedForce force;
    std::uint32_t echo = 0;
    std::uint64_t number = 0, made_ns = 0;
  };
  bool send(const GatedForce& force, std::uint32_t echo);
  bool send_fixed(const FixedReport& report);
  template <class Write>
  bool timed(const Write& write);
  void publish(std::uint64_t now_ns);
  void say_goodbye();

  const Profile& profile_;
  Transport& transport_;
  Link& link_;
  Mailbox<Letter> letters_;
  Mailbox<WriterStatus> status_;
  Mailbox<SentReport> sent_;
  Event wake_;
  std::atomic<bool> is_stopping_{false}, is_muted_{false}, has_failed_{false}, has_left_zero_{true},
      is_pushing_{false};  // the last: what was sent last enables the device
  std::atomic<std::uint64_t> stall_{0};
  std::atomic<std::uint64_t> stop_ns_{0};   // when the stop was asked for
  std::atomic<std::uint64_t> began_ns_{0};  // of the write in progress
  std::atomic<std::uint64_t> put_{0}, done_{0};
  std::atomic<std::uint32_t> sequence_{1};
  std::uint64_t put_number_ = 0, seen_done_ = 0, progress_ns_ = 0, stalls_ = 0;  // the servo thread's
  WriterStatus counts_;
  std::uint64_t published_ns_ = 0;
  std::uint8_t report_[kMaxReportBytes] = {};
};

}  // namespace fdcg::dev
