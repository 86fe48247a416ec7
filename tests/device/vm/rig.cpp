// SPDX-License-Identifier: Apache-2.0
#include "rig.hpp"

#include <poll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "clock_shim.h"
#include "host_files.hpp"
#include "suspend.hpp"

namespace fdcg::vm {
namespace {

constexpr int kUntimedPatience = 10;  // where the machine around the guest takes the time that it takes
constexpr double kFeltN = 0.05;       // a force that is surely one
constexpr Nanoseconds kFeelLimit = 6 * kSecond, kArmPause = 200 * kMillisecond, kEndLimit = 8 * kSecond;
constexpr Nanoseconds kRest = 150 * kMillisecond;  // above, between two taps: faster ones, in place, are taken for shaking

std::unique_ptr<Port> make_port(const RigOptions& options) {
  PortIdentity identity;
  identity.report_descriptor.assign(fdcg_fw_report_descriptor, fdcg_fw_report_descriptor + FDCG_FW_DESCRIPTOR_BYTES);
  return options.is_usb ? make_usb_port(std::move(identity)) : make_uhid_port(std::move(identity));
}

int make_timer() {
  const int fd = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  if (fd < 0) throw std::runtime_error("no timer");
  return fd;
}

timespec as_timespec(Nanoseconds time) {
  return {time / kSecond, time % kSecond};
}

std::uint64_t expirations(int timer) {
  std::uint64_t count = 0;
  return read(timer, &count, sizeof count) == sizeof count ? count : 0;
}

}  // namespace

Rig::Rig(const RigOptions& wanted)
    : options(wanted),
      device(make_port(wanted), wanted.rate_hz, wanted.has_float_axes, wanted.has_watchdog),
      random_(wanted.seed) {
  write_host_files(options);
  add_to_boot_clock(0);
  ticker_ = make_timer();
  alarm_ = make_timer();
  itimerspec rhythm{};
  rhythm.it_interval = as_timespec(period());
  rhythm.it_value = as_timespec(now_ns() / period() * period() + period());
  timerfd_settime(ticker_, TFD_TIMER_ABSTIME, &rhythm, nullptr);
}

Rig::~Rig() {
  device.unplug();
  close(ticker_);
  close(alarm_);
}

void Rig::run_until(Nanoseconds moment) {
  const itimerspec alarm{{}, as_timespec(moment)};
  timerfd_settime(alarm_, TFD_TIMER_ABSTIME, &alarm, nullptr);
  while (now_ns() < moment) {
    pollfd ready[] = {
        {device.fd(), POLLIN, 0}, {ticker_, POLLIN, 0}, {host.fd(), POLLIN, 0}, {alarm_, POLLIN, 0}, {second.fd(), POLLIN, 0}};
    if (poll(ready, 5, -1) < 0) continue;
    if (ready[1].revents != 0) {
      const std::uint64_t ticks = expirations(ticker_);
      missed_ticks += ticks > 1 ? ticks - 1 : 0;
      late_ticks += ticks > 0 && now_ns() % period() > period() / 4;  // the rhythm is in step with the clock
      if (ticks > 0) device.tick();
    }
    if (ready[0].revents != 0) device.receive();
    if (ready[2].revents != 0) host.receive();
    if (ready[3].revents != 0) expirations(alarm_);
    if (ready[4].revents != 0) second.receive();
  }
}

bool Rig::run_until(const Condition& condition, Nanoseconds limit) {
  const Nanoseconds end = now_ns() + (options.is_timed ? 1 : kUntimedPatience) * limit;
  while (!condition() && now_ns() < end)
    run_for(period());
  return condition();
}

void Rig::start_host() {
  host.start(host_command(options), options.has_clock_shim ? kClockShim : nullptr);
}

bool Rig::is_answered_again(Nanoseconds limit) {
  const std::uint64_t answered = device.record.answered;
  return run_until([&] { return device.record.answered > answered; }, limit);
}

bool Rig::end_host() {
  host.say("quit");
  return run_until([&] { return !host.is_running(); }, kEndLimit);
}

bool Rig::feel() {
  const Nanoseconds end = now_ns() + kFeelLimit;
  if (!device.hand.is_above()) {
    device.hand.above();
    run_until([&] { return device.hand.is_above(); }, kSecond);
    run_for(kRest);
  }
  const auto is_felt = [&] { return device.record.force_n > kFeltN; };
  const std::uint64_t answered = device.record.answered;
  run_until([&] { return device.record.answered > answered; }, kFeelLimit);
  while (now_ns() < end && host.is_running()) {
    host.say("arm");
    if (!run_until([&] { return device.record.is_enabled; }, kArmPause)) continue;
    device.hand.below();
    if (run_until(is_felt, kSecond)) return true;
    device.hand.above();
    run_for(kArmPause);
  }
  return false;
}

Nanoseconds Rig::random_between(Nanoseconds least, Nanoseconds most) {
  return least + static_cast<Nanoseconds>(random_() % static_cast<std::uint64_t>(most - least + 1));
}

bool Rig::refresh_status(Nanoseconds limit) {
  // the first line may have been under way before; the second has all
  const std::uint64_t before = host.status_count();
  return run_until([&] { return host.status_count() >= before + 2 || !host.is_running(); }, limit);
}

bool Rig::host_says_log_failed() {
  return refresh_status() && host.status_line().find("\"log_failure\":") != std::string::npos;
}

void Rig::say_host_words(Verdicts& verdicts) const {
  const Record& record = device.record;
  verdicts.say(words(
      "  device: %llu reports sent, %llu answered; %llu outputs, %llu refused; enabled %d, force %.3f N, %llu watchdog trips",
      static_cast<unsigned long long>(record.sent), static_cast<unsigned long long>(record.answered),
      static_cast<unsigned long long>(record.outputs), static_cast<unsigned long long>(record.refused), record.is_enabled,
      record.force_n, static_cast<unsigned long long>(record.watchdog_trips)));
  for (const std::string& line : host.words())
    verdicts.say("  host: " + line);
  if (host.status_count() > 0) verdicts.say("  host: " + host.status_line());
}

}  // namespace fdcg::vm
