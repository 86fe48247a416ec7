// SPDX-License-Identifier: Apache-2.0
// A device's servo loop: waits for a report, drains to the newest, gathers the input of device_tick, hands the force to the
// writer and the tick to the log. The thread sleeps in the read, 1 ms at most; it also ticks while the device is absent, so
// that commands and faults are processed. No heap, no lock, no exception from the first tick to the last (except inside the
// read of hidapi's libusb back end).
//
// Devices that share a scene have one thread: run_together ticks their loops as one. It waits for the report of the clock
// device (scene_tick.hpp) and takes the queued reports of the others, so a silent or absent device delays the others by at most
// 1 ms.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "base/mailbox.hpp"
#include "base/ring.hpp"
#include "base/threads.hpp"
#include "host/status.hpp"
#include "host/writer.hpp"
#include "recording/session_log.hpp"
#include "tick/device_tick.hpp"
#include "tick/link.hpp"
#include "tick/snapshot.hpp"
#include "tick/transport.hpp"

namespace fdcg::dev {

inline constexpr int kReadTimeoutMs = 1;
inline constexpr std::uint64_t kAwayTickNs = 1'000'000;  // of devices that share a scene, while none of them is there

struct ServoParts {
  Transport* transport = nullptr;
  Link* link = nullptr;
  Writer* writer = nullptr;
  LogRing* log = nullptr;                   // may be null
  int log_place = 0;                        // among the ring's devices
  Event* lost = nullptr;                    // signalled when the reader finds the device gone
  Event* stalled = nullptr;                 // signalled when the writer hangs; may be null
  std::vector<const ObjectConfig*> moving;  // in the order of DeviceSetup::driven
  std::uint64_t start_ns = 0;               // the motions' time 0
};

class ServoLoop {
 public:
  // Before the thread runs. False with *error where the scene refuses the fingers. What `parts` points to must outlive it.
  bool begin(const DeviceSetup& setup, const ServoParts& parts, fdcg_error* error);

  // The thread's body, until request_stop; or tick by tick, by one thread.
  void run();
  void tick();
  // The same for loops that share a scene, in the scene's order, until one of them gets request_stop. *clock: the index of the
  // loop whose report is waited for; 0 at first.
  static void run_together(ServoLoop* const* loops, int count);
  static void tick_together(ServoLoop* const* loops, int count, int* clock);

  // Callable from any thread. Both at once: disarmed.
  void request_arm() { arm_.store(true, std::memory_order_release); }
  void request_disarm() { disarm_.store(true, std::memory_order_release); }
  void request_stop();
  // For the supervisor: the opening of the link (Link::opened()) at which the reader found the device lost. 0: none yet.
  std::uint64_t lost_opening() const { return lost_opening_.load(std::memory_order_acquire); }

  // For one thread at a time. `moving`: index in ServoParts::moving; has an effect only on objects with MotionKind::kDriven.
  void set_pose(int moving, const fdcg_pose& pose) { driven_poses_[moving].put(pose); }
  bool take_status(DeviceStatus* status) { return status_.take(status); }
  // Before the thread runs: how many ticks are kept for take_snapshots; 0, the default: none.
  void keep_snapshots(std::size_t ticks) { snapshots_.resize(ticks); }
  Ring<fdcg_snapshot>& snapshots() { return snapshots_; }

 private:
  void gather(bool waits);
  void read_reports(bool waits);
  bool read_one(int timeout_ms);
  void set_poses();
  void send_force();
  void note_tick();
  void put_snapshot();
  bool is_open() const { return !is_lost_ || parts_.link->opened() != seen_opened_; }
  void publish(std::uint64_t now_ns);

  ServoParts parts_;
  DeviceState device_;
  TickInput input_;
  TickOutput output_;
  DeviceStatus status_now_;
  Mailbox<DeviceStatus> status_;
  Ring<fdcg_snapshot> snapshots_;
  std::uint64_t ticks_ = 0;
  Mailbox<fdcg_pose> driven_poses_[kMaxDriven];
  Event stop_;
  std::atomic<bool> is_stopping_{false}, arm_{false}, disarm_{false};
  std::atomic<std::uint64_t> lost_opening_{0};
  std::uint64_t seen_opened_ = 0;  // Link::opened() at the last look
  bool begins_ = false, is_lost_ = true, was_inside_ = false;
  std::uint64_t seen_stall_ = 0;  // of the writer
  std::uint64_t last_good_ns_ = 0, published_ns_ = 0, done_ns_ = 0;
  std::uint8_t scratch_[kMaxReportBytes + 1] = {};  // one more, so that a report that is too long shows
};

}  // namespace fdcg::dev
