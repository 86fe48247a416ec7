// SPDX-License-Identifier: Apache-2.0
// The reader advances the simulation: each read simulates up to the present in order of time, with the forces that the writer
// has put in a ring buffer with their times. So there is no third thread and no lock, and each force acts from the time of its
// write, however late the reader is.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "base/threads.hpp"
#include "transport/simulated_body.hpp"
#include "transport/simulated_faults.hpp"
#include "transport/transports.hpp"

namespace fdcg::dev {
namespace {

constexpr std::uint64_t kWriteTimeoutNs = 5'000'000'000;  // that hidapi waits for a device that takes no output
constexpr std::uint64_t kOpenTryNs = 10'000'000;          // that an attempt to open takes in virtual time
constexpr std::uint32_t kKeptReports = 64;                // by the kernel, of a host that does not read
constexpr std::uint32_t kOnTheWay = 1024;                 // of late ones
using Kind = SimulatedFaultKind;

// Of one writer, for one reader. Full: the reader has been away for long.
class OutputRing {
 public:
  struct Output {
    std::uint64_t time_ns = 0;
    int bytes = 0;
    std::uint8_t data[kMaxReportBytes] = {};
  };
  bool put(std::uint64_t time_ns, const std::uint8_t* data, int bytes) {
    const std::uint32_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == kSlots) return false;
    Output& output = slots_[head % kSlots];
    output.time_ns = time_ns;
    output.bytes = std::min(bytes, static_cast<int>(kMaxReportBytes));
    std::memcpy(output.data, data, static_cast<std::size_t>(output.bytes));
    head_.store(head + 1, std::memory_order_release);
    return true;
  }
  // Null: nothing there. Stays until drop().
  const Output* front() const {
    const std::uint32_t tail = tail_.load(std::memory_order_relaxed);
    return tail == head_.load(std::memory_order_acquire) ? nullptr : &slots_[tail % kSlots];
  }
  void drop() { tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  static constexpr std::uint32_t kSlots = 1024;
  Output slots_[kSlots];
  alignas(64) std::atomic<std::uint32_t> head_{0};
  alignas(64) std::atomic<std::uint32_t> tail_{0};
};

class SimulatedTransport final : public Transport {
 public:
  explicit SimulatedTransport(const SimulationConfig& config)
      : is_real_time_(config.is_real_time), rate_hz_(config.rate_hz), record_(config.record), faults_(config), body_(config) {}
  std::string open() override;
  void close() override;
  ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) override;
  bool write(const std::uint8_t* data, int bytes) override;
  std::uint64_t clock_ns() const override { return is_real_time_ ? 0 : now_ns(); }
  bool write_feature(const std::uint8_t*, int) override { return false; }  // its one feature report is read only

 private:
  std::uint64_t now_ns() const;
  void sleep_until(std::uint64_t time_ns);
  std::uint64_t next_due_ns() const;
  void live_until(std::uint64_t time_ns);
  void take_outputs(std::uint64_t time_ns);
  void report_due();
  void send(const SimulatedPacket& packet);
  bool has_arrived(std::uint64_t time_ns) const {
    return queue_tail_ != queue_head_ && queue_[queue_tail_ % kOnTheWay].arrival_ns <= time_ns;
  }
  ReadResult hand_over(std::uint8_t* data, int capacity);

  const bool is_real_time_;
  const double rate_hz_;
  const std::shared_ptr<SimulationRecord> record_;
  SimulatedFaults faults_;
  bool has_begun_ = false;  // set while neither reader nor writer is inside
  std::uint64_t origin_ns_ = 0, opened_ns_ = 0;
  OutputRing outputs_;
  std::atomic<std::uint64_t> virtual_ns_{0};
  // The reader's.
  SimulatedBody body_;
  std::uint64_t next_report_ = 0;
  bool is_plugged_ = false, is_holding_ = false;
  SimulatedPacket held_;
  SimulatedPacket queue_[kOnTheWay];  // on the way, or waiting to be read
  std::uint32_t queue_head_ = 0, queue_tail_ = 0;
};

// Since the first opening.
std::uint64_t SimulatedTransport::now_ns() const {
  return is_real_time_ ? monotonic_ns() - origin_ns_ : virtual_ns_.load(std::memory_order_acquire);
}

void SimulatedTransport::sleep_until(std::uint64_t time_ns) {
  if (!is_real_time_) {
    if (time_ns > now_ns()) virtual_ns_.store(time_ns, std::memory_order_release);
    return;
  }
  const std::uint64_t at = origin_ns_ + time_ns;
  const timespec when = {static_cast<time_t>(at / 1'000'000'000), static_cast<long>(at % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) == EINTR) {
  }
}

std::string SimulatedTransport::open() {
  if (!has_begun_) {
    has_begun_ = true;
    if (is_real_time_) origin_ns_ = monotonic_ns();
    if (record_ != nullptr) record_->origin_ns = origin_ns_;
  } else if (!is_real_time_) {
    sleep_until(now_ns() + kOpenTryNs);
  }
  const std::uint64_t now = now_ns();
  if (const int fault = faults_.lasting(Kind::kUnplug, now); fault != SimulatedFaults::kNone) {
    const std::uint64_t end = faults_.end_ns(fault);
    if (end == SimulationRecord::kNever) return "the simulated device is unplugged for good by its fault script";
    return "the simulated device is unplugged for another " + std::to_string((end - now) / 1'000'000) +
           " ms by its fault script";
  }
  while (outputs_.front() != nullptr)
    outputs_.drop();
  queue_tail_ = queue_head_;
  is_holding_ = false;
  body_.advance(now);
  body_.power_up();
  opened_ns_ = now;
  next_report_ = 1;
  is_plugged_ = true;
  return "";
}

// So that the record reaches to the end, watchdog included.
void SimulatedTransport::close() {
  if (has_begun_) live_until(now_ns());
  is_plugged_ = false;
}

ReadResult SimulatedTransport::read(std::uint8_t* data, int capacity, int timeout_ms) {
  std::uint64_t now = now_ns();
  const std::uint64_t deadline = now + static_cast<std::uint64_t>(std::max(0, timeout_ms)) * 1'000'000;
  for (;;) {
    live_until(now);
    if (has_arrived(now)) return hand_over(data, capacity);
    if (!is_plugged_) {
      faults_.notice_unplugging(now);
      return {ReadStatus::kLost, 0};
    }
    if (now >= deadline) return {ReadStatus::kTimeout, 0};
    std::uint64_t next = std::min({deadline, next_due_ns(), faults_.unplugged_at(opened_ns_)});
    if (queue_tail_ != queue_head_) next = std::min(next, queue_[queue_tail_ % kOnTheWay].arrival_ns);
    sleep_until(next);
    now = now_ns();
  }
}

ReadResult SimulatedTransport::hand_over(std::uint8_t* data, int capacity) {
  const SimulatedPacket& packet = queue_[queue_tail_++ % kOnTheWay];
  const int bytes = std::clamp(packet.bytes, 0, capacity);
  std::memcpy(data, packet.data, static_cast<std::size_t>(bytes));
  faults_.notice(packet.fault, now_ns());
  return {ReadStatus::kReport, bytes};
}

std::uint64_t SimulatedTransport::next_due_ns() const {
  return opened_ns_ + static_cast<std::uint64_t>(static_cast<double>(next_report_) * 1e9 / rate_hz_);
}

// Processes all events up to then in order: forces written, reports due, unplugging.
void SimulatedTransport::live_until(std::uint64_t time_ns) {
  const std::uint64_t unplugged = faults_.unplugged_at(opened_ns_);
  while (is_plugged_) {
    const std::uint64_t next = std::min(next_due_ns(), unplugged);
    take_outputs(std::min(next, time_ns));
    if (next > time_ns) break;
    body_.advance(next);
    if (next == unplugged) {
      body_.unplug();
      is_plugged_ = false;
    } else {
      ++next_report_;
      report_due();
    }
  }
  body_.advance(time_ns);
}

void SimulatedTransport::take_outputs(std::uint64_t time_ns) {
  for (const OutputRing::Output* output = outputs_.front(); output != nullptr && output->time_ns <= time_ns;
       output = outputs_.front()) {
    body_.advance(output->time_ns);  // a writer that was overtaken between clock and ring is taken a little later
    body_.take(output->data, output->bytes);
    outputs_.drop();
  }
}

void SimulatedTransport::report_due() {
  const std::uint64_t now = body_.time_ns();
  if (faults_.restarts(now)) body_.power_up();
  body_.set_fault(faults_.lasting(Kind::kDeviceFault, now) != SimulatedFaults::kNone);
  if (const int stall = faults_.lasting(Kind::kStall, now); stall != SimulatedFaults::kNone) {
    faults_.notice(stall, now);
    return;
  }
  SimulatedPacket packet;
  packet.bytes = FDCG_FW_INPUT_BYTES;
  packet.arrival_ns = now;
  body_.make_report(packet.data);
  const bool is_to_wait = faults_.touch(&packet);
  if (is_to_wait && !is_holding_) {
    held_ = packet;
    is_holding_ = true;
    return;
  }
  send(packet);
  if (is_holding_) send(held_);
  is_holding_ = false;
}

// Into the kernel's queue, behind those that are on the way. The kernel keeps the oldest and drops what comes after.
void SimulatedTransport::send(const SimulatedPacket& packet) {
  const std::uint64_t now = body_.time_ns();
  std::uint32_t waiting = 0;
  while (waiting < queue_head_ - queue_tail_ && queue_[(queue_tail_ + waiting) % kOnTheWay].arrival_ns <= now)
    ++waiting;
  if (waiting >= kKeptReports || queue_head_ - queue_tail_ >= kOnTheWay) {
    if (record_ != nullptr) ++record_->reports_lost;
    return;
  }
  queue_[queue_head_++ % kOnTheWay] = packet;
}

bool SimulatedTransport::write(const std::uint8_t* data, int bytes) {
  std::uint64_t now = now_ns();
  const std::uint64_t unplugged = faults_.unplugged_at(opened_ns_);
  if (const int fault = faults_.lasting(Kind::kNoOutput, now); fault != SimulatedFaults::kNone) {
    faults_.notice(fault, now);
    if (!is_real_time_) return false;
    const std::uint64_t end = faults_.end_ns(fault), timeout = now + kWriteTimeoutNs;
    sleep_until(std::min({end, timeout, unplugged}));
    if (end > timeout) return false;
    now = now_ns();
  }
  if (now < unplugged) return outputs_.put(now, data, bytes);
  faults_.notice_unplugging(now);
  return false;
}

}  // namespace

std::unique_ptr<Transport> make_simulated_transport(const SimulationConfig& config) {
  return std::make_unique<SimulatedTransport>(config);
}

}  // namespace fdcg::dev
