// SPDX-License-Identifier: Apache-2.0
#include "host/supervisor.hpp"

#include <algorithm>

namespace fdcg::dev {

namespace {

constexpr std::uint64_t kMs = 1'000'000;
constexpr std::uint64_t kSoonNs = 100 * kMs, kLaterNs = 1000 * kMs;  // between attempts to open
constexpr std::uint64_t kSoonForNs = 5000 * kMs;                     // an unplugged device is usually back by then
constexpr std::uint64_t kZeroForceNs = 20 * kMs;                     // for the zero force of the tick that found the loss
constexpr std::uint64_t kClosingPollNs = 2 * kMs;                    // poll interval while a thread is inside
constexpr std::uint64_t kIdleNs = 200 * kMs;

}  // namespace

void Supervisor::add(const SupervisedDevice& device) {
  auto watched = std::make_unique<Watched>();
  watched->parts = device;
  devices_.push_back(std::move(watched));
}

void Supervisor::request_stop() {
  is_stopping_.store(true, std::memory_order_release);
  wake_.signal();
}

void Supervisor::run() {
  const std::uint64_t start_ns = monotonic_ns();
  for (const auto& device : devices_)
    device->absent_since_ns = device->next_try_ns = start_ns;
  while (!is_stopping_.load(std::memory_order_acquire)) {
    for (const auto& device : devices_) {
      look_after(*device);
      if (is_stopping_.load(std::memory_order_acquire)) return;
    }
    const std::uint64_t now_ns = monotonic_ns();
    std::uint64_t until_ns = now_ns + kIdleNs;
    for (const auto& device : devices_) {
      if (device->state == State::kClosing) until_ns = std::min(until_ns, now_ns + kClosingPollNs);
      if (device->state == State::kAbsent) until_ns = std::min(until_ns, device->next_try_ns);
    }
    if (until_ns > now_ns) wake_.wait(until_ns - now_ns);
  }
}

void Supervisor::look_after(Watched& device) {
  if (device.state == State::kOpen && device.parts.servo->lost_opening() == device.parts.link->opened()) begin_closing(device);
  const std::uint64_t now_ns = monotonic_ns();
  if (device.state == State::kClosing) try_to_close(device, now_ns);
  if (device.state == State::kAbsent && now_ns >= device.next_try_ns) try_to_open(device, now_ns);
}

void Supervisor::begin_closing(Watched& device) {
  device.parts.writer->flush_within(kZeroForceNs);
  device.parts.link->close();
  device.state = State::kClosing;
}

void Supervisor::try_to_close(Watched& device, std::uint64_t now_ns) {
  if (!device.parts.link->is_empty()) return;
  device.parts.emergency->descriptor.store(-1);
  device.parts.emergency->call.store(nullptr);
  device.parts.transport->close();
  device.absent_since_ns = now_ns;
  device.next_try_ns = now_ns - device.opened_ns < kSoonForNs ? now_ns + kSoonNs : now_ns;  // delays repeated failures
  const bool is_over = device.parts.transport->is_over();
  device.state = is_over ? State::kOver : State::kAbsent;
  device.is_over.store(is_over, std::memory_order_release);
  const std::lock_guard<std::mutex> lock(problem_mutex_);
  device.problem = is_over ? "the recording has ended" : "the device is gone; it is opened again when it is back";
}

void Supervisor::try_to_open(Watched& device, std::uint64_t now_ns) {
  std::string problem = device.parts.transport->open();
  if (problem.empty()) {
    device.parts.writer->forget_failure();
    device.state = State::kOpen;
    device.opened_ns = monotonic_ns();
    device.parts.emergency->descriptor.store(device.parts.transport->emergency_descriptor());
    const EmergencyCall last = device.parts.transport->emergency_call();
    device.parts.emergency->self.store(last.self);
    device.parts.emergency->call.store(last.call);
    device.parts.link->open();
  } else {
    const std::uint64_t pause_ns = now_ns - device.absent_since_ns < kSoonForNs ? kSoonNs : kLaterNs;
    device.next_try_ns = monotonic_ns() + pause_ns;
  }
  const std::lock_guard<std::mutex> lock(problem_mutex_);
  device.problem = std::move(problem);
}

std::string Supervisor::problem(int device) const {
  const std::lock_guard<std::mutex> lock(problem_mutex_);
  return devices_[static_cast<std::size_t>(device)]->problem;
}

bool Supervisor::is_over(int device) const {
  return devices_[static_cast<std::size_t>(device)]->is_over.load(std::memory_order_acquire);
}

}  // namespace fdcg::dev
