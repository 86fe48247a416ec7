// SPDX-License-Identifier: Apache-2.0
// Harm to the device as a whole, to the host program, and to the disk under its log.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "host_files.hpp"
#include "strikes.hpp"
#include "suspend.hpp"

namespace fdcg::vm {
namespace {

constexpr Nanoseconds kReopenLimit = 5 * kSecond;
constexpr char kFiller[] = "/full/filler";
constexpr std::size_t kFilledAtOnce = 32 * 1024;

}  // namespace

// Away for a moment or for a while, with or without its motors' supply. The force dies by the watchdog; after the re-plug there
// is none before it is armed.
Expectation strike_unplugged(Rig& rig) {
  Expectation expected;
  expected.known = now_ns();
  expected.is_by_watchdog = expected.disarms = true;
  rig.device.record.watch(expected.known);
  rig.device.unplug();
  const bool is_brief = rig.random_between(0, 3) == 0;
  rig.run_for(is_brief ? rig.random_between(0, 2 * kMillisecond) : rig.random_between(30 * kMillisecond, 300 * kMillisecond));
  rig.device.plug(rig.random_between(0, 1) == 0);
  const Nanoseconds plugged = now_ns();
  if (!rig.is_answered_again(kReopenLimit)) expected.broken = "the host has not opened it again within 5 s";
  rig.longest_reopening = std::max(rig.longest_reopening, now_ns() - plugged);
  rig.run_for(kSecond / 10);
  return expected;
}

// Plugged in again, it says of itself what the profile does not fit: nobody drives it until it is the old one again.
Expectation strike_other_description(Rig& rig) {
  // of version, number of axes, what they measure, counts, rate
  constexpr int kBytes[] = {1, 3, 4, 6, 29};
  Expectation expected;
  expected.known = now_ns();
  expected.is_by_watchdog = expected.disarms = true;
  rig.device.record.watch(expected.known);
  rig.device.unplug();
  rig.device.misdescribe(kBytes[rig.random_between(0, 4)]);
  rig.device.plug(true);
  const std::uint64_t answered = rig.device.record.answered;
  const auto is_told = [&] {
    const std::string& line = rig.host.status_line();
    return line.find("feature report says") != std::string::npos || line.find("the device measures") != std::string::npos;
  };
  if (!rig.run_until(is_told, 3 * kSecond)) expected.broken = "the host does not say what does not fit";
  rig.host.say("arm");
  rig.run_for(kSecond / 2);
  if (rig.device.record.answered != answered) expected.broken = "a device that does not fit its profile is driven";
  rig.device.unplug();
  rig.device.misdescribe(-1);
  rig.device.plug(true);
  if (!rig.is_answered_again(kReopenLimit)) expected.broken = "the host has not opened it again within 5 s";
  rig.run_for(kSecond / 10);
  return expected;
}

// uhid keeps 32 reports for the device and drops the rest; usbhid blocks the write and gives up after 5 s. Either way the first
// thing that the device takes afterwards is old.
Expectation strike_no_output(Rig& rig) {
  Expectation expected;
  expected.known = now_ns();
  expected.is_by_watchdog = expected.disarms = true;
  rig.device.record.watch(expected.known);
  rig.device.take_output(false);
  rig.run_for(7 * kSecond);
  rig.device.take_output(true);
  if (!rig.is_answered_again(kReopenLimit)) expected.broken = "the host writes nothing 5 s after the device takes output again";
  rig.run_for(kSecond / 10);
  return expected;
}

// Its firmware begins anew between two reports: its sequence, clock and echo too.
Expectation strike_restarted(Rig& rig) {
  Expectation expected;
  rig.device.restart();
  expected.known = now_ns();
  expected.disarms = true;
  rig.device.record.watch(expected.known);
  rig.run_for(kSecond / 10);
  return expected;
}

// What it sends is zero; what must not come back by itself is the force of this host.
Expectation strike_other_host(Rig& rig) {
  Expectation expected;
  expected.known = now_ns();
  expected.disarms = true;
  rig.device.record.watch(expected.known);
  rig.device.hear_another(static_cast<std::uint32_t>(rig.random_between(100, 1'000'000)));
  rig.run_for(kSecond / 10);
  return expected;
}

// The device's watchdog takes the force away; from the moment that the host runs again it is the host's.
Expectation strike_asleep(Rig& rig) {
  Expectation expected;
  expected.is_by_watchdog = expected.disarms = true;
  rig.device.record.watch(now_ns());
  rig.host.signal(SIGSTOP);
  rig.run_for(300 * kMillisecond);
  expected.known = now_ns();
  rig.host.signal(SIGCONT);
  rig.run_for(kSecond / 10);
  return expected;
}

// The host's clock that counts suspended time too goes ahead by so much, as after a suspend that its reports hide.
Expectation strike_clock_jump(Rig& rig) {
  Expectation expected;
  expected.disarms = true;
  const Nanoseconds slept = rig.random_between(20 * kMillisecond, 3600 * kSecond);
  add_to_boot_clock(slept);
  expected.known = now_ns();
  rig.device.record.watch(expected.known);
  rig.run_for(kSecond / 10);
  return expected;
}

// The whole guest, to memory, until it is woken from outside. The device's time stands still meanwhile, and it has no watchdog:
// what takes the force away is the host's word after it.
Expectation strike_suspended(Rig& rig) {
  Expectation expected;
  expected.disarms = true;
  expected.oldest_answer = kSecond;  // a force on its way into the suspend
  suspend_to_memory();
  expected.known = now_ns();
  rig.device.record.watch(expected.known);
  rig.run_for(kSecond / 10);
  return expected;
}

Expectation strike_killed(Rig& rig) {
  Expectation expected;
  expected.known = now_ns();
  expected.is_by_watchdog = expected.disarms = true;
  rig.device.record.watch(expected.known);
  rig.host.signal(SIGKILL);
  if (!rig.run_until([&] { return !rig.host.is_running(); }, kSecond)) expected.broken = "the killed host does not end";
  rig.run_for(rig.random_between(0, kSecond / 10));
  rig.start_host();
  if (!rig.is_answered_again(kReopenLimit)) expected.broken = "a new host has not opened the device within 5 s";
  rig.run_for(kSecond / 10);
  return expected;
}

// Nothing happens to the force; the host says that its log has ended, and only that.
Expectation strike_disk_full(Rig& rig) {
  Expectation expected;
  const int filler = open(kFiller, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (filler < 0) throw std::runtime_error("the small disk does not open");
  const std::string block(kFilledAtOnce, 'x');
  while (write(filler, block.data(), block.size()) > 0)
    rig.run_for(rig.period());  // the device itself must not be late
  close(filler);
  rig.run_for(kSecond / 2);
  if (!rig.host_says_log_failed()) expected.broken = "the host does not say that its log has ended";
  if (rig.options.is_timed && !(rig.device.record.force_n > 0)) expected.broken = "the force is gone";
  if (!expected.broken.empty()) return expected;
  if (!rig.end_host() || rig.host.ending() >= 128) expected.broken = "the host does not end in order";
  for (const auto& entry : std::filesystem::directory_iterator(kSmallDisk))
    std::filesystem::remove(entry.path());
  rig.start_host();
  expected.may_disarm = true;  // by its end
  return expected;
}

}  // namespace fdcg::vm
