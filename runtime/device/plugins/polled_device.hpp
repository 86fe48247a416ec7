// SPDX-License-Identifier: Apache-2.0
// A device that is asked by its maker's library, once a period, as a plugin (fdcg/transport.h): a thread of its own exchanges
// the newest force for a sample, so that neither the servo thread nor the writer waits for the library, which is used by that
// thread alone. Header only, for the plugins of this folder. Linux.
#pragma once

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <thread>

#include "base/mailbox.hpp"
#include "base/ring.hpp"
#include "fdcg/transport.h"
#include "settings.hpp"

namespace fdcg::plugin {

class PolledDevice {
 public:
  explicit PolledDevice(double rate_hz) : period_(static_cast<std::int64_t>(1e9 / rate_hz)) { samples_.resize(256); }
  virtual ~PolledDevice() {
    if (wake_ >= 0) ::close(wake_);
  }
  PolledDevice(const PolledDevice&) = delete;
  PolledDevice& operator=(const PolledDevice&) = delete;

  // Fills a transport with this device, which it then owns.
  static void hand_over(std::unique_ptr<PolledDevice> device, fdcg_transport* transport) {
    transport->self = device.release();
    transport->open = [](void* self, fdcg_host_message* why) { return of(self).open(why); };
    transport->close = [](void* self) { of(self).close(); };
    transport->read = [](void* self, std::int32_t timeout_ms, fdcg_transport_sample* sample) {
      return of(self).read(timeout_ms, sample);
    };
    transport->write = [](void* self, const fdcg_transport_force* force) { return of(self).write(*force); };
    transport->emergency = [](void* self) { of(self).mute(); };
    transport->destroy = [](void* self) { delete &of(self); };
  }

 protected:
  // All three by the same thread at a time. Empty, or what is missing and what to do.
  virtual std::string connect() = 0;
  virtual void disconnect() = 0;
  // Sends the force, gets a place: position_m, buttons, orientation, and FDCG_TRANSPORT_FAULT if there is one. False: the
  // device is gone. is_enabled is 0 where force_n is zero.
  virtual bool exchange(const fdcg_transport_force& force, fdcg_transport_sample* sample) = 0;
  // Ends the force, and an exchange that hangs, if it can: before disconnect(), and in a signal's handler.
  virtual void stop_at_once() noexcept {}

 private:
  static PolledDevice& of(void* self) { return *static_cast<PolledDevice*>(self); }

  int open(fdcg_host_message* why) {
    if (wake_ < 0) wake_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    const std::string problem = wake_ < 0 ? "no event descriptor" : connect();
    if (!problem.empty()) {
      std::snprintf(why->text, sizeof why->text, "%s", problem.c_str());
      return FDCG_TRANSPORT_FAILED;
    }
    forces_.put({});
    fdcg_transport_sample old;
    while (samples_.take(&old, 1) > 0) {
    }
    is_lost_ = is_stopping_ = has_ended_ = is_muted_ = false;
    try {
      thread_ = std::thread([this] { run(); });
    } catch (const std::exception& error) {
      disconnect();
      std::snprintf(why->text, sizeof why->text, "its thread cannot be started: %s", error.what());
      return FDCG_TRANSPORT_FAILED;
    }
    return FDCG_TRANSPORT_OK;
  }

  // The thread's last exchange sends zero; one that hangs is ended.
  void close() {
    is_stopping_ = true;
    const auto until = std::chrono::steady_clock::now() + std::chrono::nanoseconds(2 * period_) + kGoodbye;
    while (!has_ended_ && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    stop_at_once();
    if (thread_.joinable()) thread_.join();
    disconnect();
  }

  int read(std::int32_t timeout_ms, fdcg_transport_sample* sample) {
    if (samples_.take(sample, 1) > 0) return FDCG_TRANSPORT_SAMPLE;
    pollfd wake{wake_, POLLIN, 0};
    if (!is_lost_ && timeout_ms > 0 && poll(&wake, 1, timeout_ms) > 0) {
      std::uint64_t count = 0;
      static_cast<void>(::read(wake_, &count, sizeof count) < 0);
    }
    if (samples_.take(sample, 1) > 0) return FDCG_TRANSPORT_SAMPLE;
    return is_lost_ ? FDCG_TRANSPORT_FAILED : FDCG_TRANSPORT_OK;
  }

  int write(const fdcg_transport_force& force) {
    if (force.is_enabled == 0) is_muted_ = false;  // the host's own zero: it goes on
    forces_.put(force);
    return is_lost_ ? FDCG_TRANSPORT_FAILED : FDCG_TRANSPORT_OK;
  }

  // The thread's next exchange sends zero, if the process lives so long.
  void mute() noexcept {
    is_muted_ = true;
    stop_at_once();
    const timespec two_periods{0, static_cast<long>(2 * period_)};
    nanosleep(&two_periods, nullptr);
  }

  void run() {
    using Clock = std::chrono::steady_clock;
    const auto began = Clock::now();
    auto next = began;
    fdcg_transport_force force{};
    std::uint32_t sequence = 0;
    while (!is_stopping_) {
      forces_.take(&force);
      if (is_muted_ || force.is_enabled == 0) {
        force.is_enabled = 0;
        force.force_n[0] = force.force_n[1] = force.force_n[2] = 0;
      }
      fdcg_transport_sample sample{};
      if (!exchange(force, &sample)) break;
      sample.time_s = std::chrono::duration<double>(Clock::now() - began).count();
      sample.sequence = ++sequence;
      sample.echo = force.sequence;
      if (force.is_enabled != 0) sample.flags |= FDCG_TRANSPORT_ENABLED;
      if (fdcg_transport_sample* const slot = samples_.next()) {
        *slot = sample;
        samples_.put();
      }
      wake_reader();
      next += std::chrono::nanoseconds(period_);
      if (next < Clock::now()) next = Clock::now();
      std::this_thread::sleep_until(next);
    }
    is_lost_ = !is_stopping_;
    wake_reader();
    fdcg_transport_sample unread{};
    if (!is_lost_) exchange({}, &unread);
    has_ended_ = true;
  }

  void wake_reader() {
    const std::uint64_t one = 1;
    static_cast<void>(::write(wake_, &one, sizeof one) < 0);
  }

  static constexpr std::chrono::milliseconds kGoodbye{50};  // for the last exchange
  const std::int64_t period_;                               // ns
  dev::Ring<fdcg_transport_sample> samples_;
  dev::Mailbox<fdcg_transport_force> forces_;
  std::atomic<bool> is_lost_{false}, is_stopping_{false}, is_muted_{false}, has_ended_{true};
  std::thread thread_;
  int wake_ = -1;
};

// What every plugin's one function does: `Device` is made from its settings, of such keys.
template <class Device>
int create_device(std::uint32_t abi, const char* settings, std::initializer_list<const char*> keys, fdcg_transport* transport,
                  fdcg_host_message* why) {
  if (abi != FDCG_TRANSPORT_ABI || transport->struct_bytes < sizeof *transport) return FDCG_TRANSPORT_FAILED;
  try {
    PolledDevice::hand_over(std::make_unique<Device>(Settings(settings, keys)), transport);
    return FDCG_TRANSPORT_OK;
  } catch (const std::exception& error) {
    std::snprintf(why->text, sizeof why->text, "%s", error.what());
    return FDCG_TRANSPORT_FAILED;
  }
}

}  // namespace fdcg::plugin
