// SPDX-License-Identifier: Apache-2.0
#include "host/servo_loop.hpp"

#include <algorithm>
#include <cstring>

#include "base/real_time.hpp"
#include "scene/scene_build.hpp"

namespace fdcg::dev {

bool ServoLoop::begin(const DeviceSetup& setup, const ServoParts& parts, fdcg_error* error) {
  parts_ = parts;
  for (std::size_t i = 0; i < parts_.moving.size(); ++i)
    input_.poses[i] = parts_.moving[i]->pose;
  input_.pose_count = static_cast<std::uint32_t>(parts_.moving.size());
  return begin_device(setup, &device_, error);
}

void ServoLoop::request_stop() {
  is_stopping_.store(true, std::memory_order_release);
  stop_.signal();
}

void ServoLoop::run() {
  prepare_servo_thread();
  while (!is_stopping_.load(std::memory_order_acquire))
    tick();
  publish(monotonic_ns());
}

void ServoLoop::run_together(ServoLoop* const* loops, int count) {
  prepare_servo_thread();
  const auto is_stopping = [](const ServoLoop* loop) { return loop->is_stopping_.load(std::memory_order_acquire); };
  for (int clock = 0; std::none_of(loops, loops + count, is_stopping);)
    tick_together(loops, count, &clock);
  for (int i = 0; i < count; ++i)
    loops[i]->publish(monotonic_ns());
}

void ServoLoop::tick() {
  ServoLoop* const alone = this;
  int clock = 0;
  tick_together(&alone, 1, &clock);
}

// The device whose report the loop waits for: the clock device while it is open, else the first open one; if none is open, the
// clock device, whose wait is then a sleep.
void ServoLoop::tick_together(ServoLoop* const* loops, int count, int* clock) {
  int waiting = *clock;
  for (int i = 0; i < count && !loops[waiting]->is_open(); ++i)
    waiting = loops[i]->is_open() ? i : waiting;
  Member members[kMaxDevices];
  loops[waiting]->gather(true);
  for (int i = 0; i < count; ++i) {
    if (i != waiting) loops[i]->gather(false);
    members[i] = {&loops[i]->device_, &loops[i]->input_, &loops[i]->output_};
  }
  *clock = group_tick(members, count);
  for (int i = 0; i < count; ++i)
    loops[i]->parts_.writer->put(loops[i]->output_.force, loops[i]->output_.echo, loops[i]->input_.now_ns);
  for (int i = 0; i < count; ++i)
    loops[i]->send_force();
  LogRing* const log = loops[0]->parts_.log;
  if (log != nullptr && log->device_count() > 1) log->put_all(members);
  if (log != nullptr && log->device_count() == 1) log->put(loops[0]->input_, loops[0]->output_);
  for (int i = 0; i < count; ++i)
    loops[i]->note_tick();
}

// waits: for a report, or the device's return.
void ServoLoop::gather(bool waits) {
  input_.report_count = 0;
  input_.read = ReadStatus::kLost;
  const std::uint64_t opened = parts_.link->opened();
  if (opened != seen_opened_) {
    seen_opened_ = opened;
    begins_ = true;
    is_lost_ = false;
  }
  // After a loss there are no reads until it has been reopened: they would fail at once, and this thread would spin.
  was_inside_ = !is_lost_ && parts_.link->enter(Link::kReader);
  if (was_inside_) {
    read_reports(waits);
    parts_.link->leave(Link::kReader);
  } else if (waits) {
    stop_.wait(kAwayTickNs);
  }
  input_.begins = begins_;
  begins_ = false;
  input_.now_ns = monotonic_ns();
  input_.slept_ns = slept_ns(input_.now_ns);
  input_.disarm = disarm_.exchange(false, std::memory_order_acq_rel);
  input_.arm = arm_.exchange(false, std::memory_order_acq_rel) && !input_.disarm;
  input_.write_busy_ns = parts_.writer->busy_ns(input_.now_ns);  // before has_failed: a write that ends between is seen there
  input_.write_failed = parts_.writer->has_failed();
  parts_.writer->take_sent(&input_.sent);
  set_poses();
}

// Waits for the oldest report, then reads all that are queued, at most kMaxDrain. The rest is read by the next tick, and judged
// by its age.
void ServoLoop::read_reports(bool waits) {
  if (!read_one(waits ? kReadTimeoutMs : 0)) return;
  while (input_.report_count < kMaxDrain && read_one(0)) {
  }
}

// False: no report, for now or for ever.
bool ServoLoop::read_one(int timeout_ms) {
  const ReadResult read = parts_.transport->read(scratch_, sizeof scratch_, timeout_ms);
  if (read.status == ReadStatus::kReport) {
    RawReport& report = input_.reports[input_.report_count++];
    report.host_ns = monotonic_ns();
    report.bytes = static_cast<std::uint16_t>(std::clamp(read.bytes, 0, kMaxReportBytes + 1));
    std::memcpy(report.data, scratch_, std::min<std::size_t>(report.bytes, kMaxReportBytes));
    input_.read = ReadStatus::kReport;
    return true;
  }
  // The time-out after a report is the end of the drain; a loss counts whatever came before it.
  if (read.status == ReadStatus::kLost || input_.report_count == 0) input_.read = read.status;
  return false;
}

void ServoLoop::set_poses() {
  const double seconds = static_cast<double>(input_.now_ns - parts_.start_ns) * 1e-9;
  for (std::size_t i = 0; i < parts_.moving.size(); ++i) {
    const ObjectConfig& object = *parts_.moving[i];
    if (object.motion.kind == MotionKind::kDriven) {
      driven_poses_[i].take(&input_.poses[i]);
    } else {
      input_.poses[i] = pose_at(object, seconds);
    }
  }
}

// Wakes the writers after all forces have been stored: no writer waits for another's wake-up, which takes microseconds.
void ServoLoop::send_force() {
  done_ns_ = monotonic_ns();
  parts_.writer->wake();
  if (const std::uint64_t stall = parts_.writer->stall(); stall != seen_stall_) {
    seen_stall_ = stall;
    if (stall != 0 && parts_.stalled != nullptr) parts_.stalled->signal();
  }
  // The supervisor is notified only now, after the zero force of this tick has been handed to the writer.
  if (input_.read == ReadStatus::kLost && !is_lost_ && was_inside_) {
    is_lost_ = true;
    lost_opening_.store(seen_opened_, std::memory_order_release);
    parts_.lost->signal();
  }
}

void ServoLoop::note_tick() {
  status_now_.work.add(done_ns_ - input_.now_ns);
  if (input_.begins) last_good_ns_ = 0;
  if (output_.has_sample) {
    if (last_good_ns_ != 0) status_now_.interval.add(input_.now_ns - last_good_ns_);
    last_good_ns_ = input_.now_ns;
    if (output_.round_trip_s > 0) status_now_.round_trip.add(static_cast<std::uint64_t>(output_.round_trip_s * 1e9));
  }
  put_snapshot();
  if (done_ns_ - published_ns_ >= kPublishNs) publish(done_ns_);
}

void ServoLoop::put_snapshot() {
  const std::uint64_t tick = ticks_++;
  fdcg_snapshot* const snapshot = snapshots_.next();
  if (snapshot == nullptr) return;
  take_snapshot(device_, output_, tick, static_cast<double>(input_.now_ns - parts_.start_ns) * 1e-9, snapshot);
  snapshots_.put();
}

void ServoLoop::publish(std::uint64_t now_ns) {
  published_ns_ = now_ns;
  status_now_.connection = is_lost_ ? Connection::kAbsent : Connection::kOpen;
  status_now_.opened = seen_opened_;
  status_now_.last = output_;
  status_now_.counters = device_.counters;
  status_now_.log_dropped = parts_.log != nullptr ? parts_.log->dropped(parts_.log_place) : 0;
  status_now_.elapsed_s = static_cast<double>(now_ns - parts_.start_ns) * 1e-9;
  status_.put(status_now_);
}

}  // namespace fdcg::dev
