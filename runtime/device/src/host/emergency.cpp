// SPDX-License-Identifier: Apache-2.0
#include "host/emergency.hpp"

#include <signal.h>
#include <unistd.h>

#include <cstring>

#ifdef __linux__
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#endif

#include "profile/report_codec.hpp"

namespace fdcg::dev {

namespace {

std::atomic<EmergencyExit*> exits[kMaxEmergencyExits];

constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr int kCrashCount = sizeof kCrashes / sizeof kCrashes[0];
struct sigaction handled_before[kCrashCount];

// hidraw wants the report id first, 0 where the device has none, as hid_write does.
void write_report(int descriptor, const std::uint8_t* report, int bytes, bool has_id) {
  std::uint8_t data[kMaxReportBytes + 1] = {};
  const int skipped = has_id ? 0 : 1;
  if (bytes < 0 || bytes > kMaxReportBytes) return;
  std::memcpy(data + skipped, report, static_cast<std::size_t>(bytes));
  const ssize_t ignored = write(descriptor, data, static_cast<std::size_t>(bytes + skipped));
  static_cast<void>(ignored);  // nobody is left to tell
}

void write_fixed(int descriptor, const FixedReport& report) {
  if (!report.is_feature) {
    write_report(descriptor, report.data, report.bytes, true);
    return;
  }
#ifdef __linux__
  std::uint8_t data[kMaxReportBytes];
  std::memcpy(data, report.data, sizeof data);
  ioctl(descriptor, HIDIOCSFEATURE(report.bytes), data);
#endif
}

void send_zero(int descriptor, const Profile& profile, std::uint32_t sequence) {
  if (!profile.has_output) return;
  Command zero;
  zero.sequence = sequence;
  std::uint8_t report[kMaxReportBytes] = {};
  encode_output(profile, zero, report);
  write_report(descriptor, report, profile.output.bytes, profile.output.id != 0);
}

void on_crash(int signal) {
  send_emergency_zeros();
  // Back to what was there before: it meets the same fault again when this handler returns, or this signal raised anew.
  for (int i = 0; i < kCrashCount; ++i) {
    if (kCrashes[i] == signal) sigaction(signal, &handled_before[i], nullptr);
  }
  raise(signal);
}

}  // namespace

bool add_emergency_exit(EmergencyExit* exit) {
  for (auto& slot : exits) {
    EmergencyExit* none = nullptr;
    if (slot.compare_exchange_strong(none, exit)) return true;
  }
  return false;
}

void remove_emergency_exit(EmergencyExit* exit) {
  for (auto& slot : exits) {
    EmergencyExit* own = exit;
    if (slot.compare_exchange_strong(own, nullptr)) return;
  }
}

void send_emergency_zeros() noexcept {
  int descriptors[kMaxEmergencyExits];
  // Zero everywhere first: a safe stop may take its time.
  for (int i = 0; i < kMaxEmergencyExits; ++i) {
    descriptors[i] = -1;
    EmergencyExit* const exit = exits[i].load();
    if (exit == nullptr) continue;
    const std::uint32_t sequence = exit->writer->mute();
    descriptors[i] = exit->descriptor.exchange(-1);
    if (descriptors[i] >= 0) send_zero(descriptors[i], *exit->profile, sequence);
  }
  for (int i = 0; i < kMaxEmergencyExits; ++i) {
    EmergencyExit* const exit = exits[i].load();
    if (exit == nullptr || descriptors[i] < 0) continue;
    for (int k = 0; k < exit->profile->safe_stop_count; ++k)
      write_fixed(descriptors[i], exit->profile->safe_stop[k]);
  }
}

void install_crash_handlers() {
  static std::atomic<bool> is_installed{false};
  if (is_installed.exchange(true)) return;
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK | SA_RESETHAND;
  sigemptyset(&action.sa_mask);
  for (int i = 0; i < kCrashCount; ++i)
    sigaction(kCrashes[i], &action, &handled_before[i]);
}

}  // namespace fdcg::dev
