// SPDX-License-Identifier: Apache-2.0
#include "host/emergency.hpp"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>

#ifdef __linux__
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#endif

#include "base/crash_signals.hpp"
#include "base/threads.hpp"
#include "profile/report_codec.hpp"

namespace fdcg::dev {

namespace {

std::atomic<EmergencyExit*> exits[kMaxEmergencyExits];
std::atomic<void (*)()> last_act{nullptr};

// Others that end a process by default. SIGKILL cannot be handled.
constexpr int kEndings[] = {
    SIGHUP, SIGINT,    SIGQUIT, SIGPIPE, SIGALRM, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ, SIGPROF, SIGPOLL, SIGVTALRM,
#ifdef __linux__
    SIGPWR, SIGSTKFLT,
#endif
};
constexpr int kMostSignal = 64;
struct sigaction handled_before[kMostSignal + 1];

constexpr std::size_t kHandlerStackBytes = 64 * 1024;
constexpr std::uint64_t kInFlightNs = 20'000'000;  // wait for a write in progress; a device that takes output needs 1 ms

enum class EmergencyState : int { kIdle, kSending, kSent };
std::atomic<EmergencyState> emergency_state{EmergencyState::kIdle};

// What a device is reached by.
struct Way {
  int descriptor = -1;
  void (*call)(void*, const std::uint8_t*, int) = nullptr;
  void* self = nullptr;

  bool is_there() const { return descriptor >= 0 || call != nullptr; }
};

// hidraw wants the report id first, 0 where the device has none, as hid_write does.
void write_report(const Way& way, const std::uint8_t* report, int bytes, bool has_id) {
  if (bytes < 0 || bytes > kMaxReportBytes) return;
  if (way.call != nullptr) return way.call(way.self, report, bytes);
  std::uint8_t data[kMaxReportBytes + 1] = {};
  const int skipped = has_id ? 0 : 1;
  std::memcpy(data + skipped, report, static_cast<std::size_t>(bytes));
  const ssize_t ignored = write(way.descriptor, data, static_cast<std::size_t>(bytes + skipped));
  static_cast<void>(ignored);  // the process is ending
}

void write_fixed(const Way& way, const FixedReport& report) {
  const int skipped = way.call != nullptr && report.data[0] == 0 ? 1 : 0;
  if (!report.is_feature) return write_report(way, report.data + skipped, report.bytes - skipped, true);
#ifdef __linux__
  std::uint8_t data[kMaxReportBytes];
  std::memcpy(data, report.data, sizeof data);
  if (way.descriptor >= 0) ioctl(way.descriptor, HIDIOCSFEATURE(report.bytes), data);
#endif
}

void send_zero(const Way& way, const Profile& profile, std::uint32_t sequence) {
  if (!profile.has_output) return;
  Command zero;
  zero.sequence = sequence;
  std::uint8_t report[kMaxReportBytes] = {};
  const int bytes = encode_output(profile, zero, report);
  write_report(way, report, bytes, profile.output.id != 0);
}

// Several threads may crash at once: the first sends the reports, the others must not end the process meanwhile. A fault within
// the handler ends the process at once, since every signal is blocked.
void on_fatal_signal(int signal) {
  EmergencyState expected = EmergencyState::kIdle;
  if (emergency_state.compare_exchange_strong(expected, EmergencyState::kSending)) {
    send_emergency_zeros();
    if (void (*const act)() = last_act.load(); act != nullptr) act();
    emergency_state.store(EmergencyState::kSent);
  }
  while (emergency_state.load() != EmergencyState::kSent)
    poll(nullptr, 0, 1);
  // Restores the previous handler, which gets this signal, raised again, when this handler returns. A process with muted
  // writers must not continue because the signal was ignored.
  struct sigaction before = handled_before[signal];
  if ((before.sa_flags & SA_SIGINFO) == 0 && before.sa_handler == SIG_IGN) before.sa_handler = SIG_DFL;
  sigaction(signal, &before, nullptr);
  raise(signal);
}

// A plugin, or a library, has called exit() with devices open; a host that was stopped has none left.
void on_exit() {
  const bool is_open = std::any_of(std::begin(exits), std::end(exits), [](const auto& slot) { return slot.load() != nullptr; });
  EmergencyState expected = EmergencyState::kIdle;
  if (!is_open || !emergency_state.compare_exchange_strong(expected, EmergencyState::kSending)) return;
  send_emergency_zeros();
  if (void (*const act)() = last_act.load(); act != nullptr) act();
  emergency_state.store(EmergencyState::kSent);
}

void install(int signal, bool is_crash) {
  struct sigaction& before = handled_before[signal];
  if (sigaction(signal, nullptr, &before) != 0) return;  // the system's own
  const bool is_default = (before.sa_flags & SA_SIGINFO) == 0 && before.sa_handler == SIG_DFL;
  if (!is_crash && !is_default) return;
  struct sigaction action {};
  action.sa_handler = on_fatal_signal;
  action.sa_flags = SA_ONSTACK;
  sigfillset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

// An alternate stack, needed when the calling thread's stack has overflowed.
void give_handler_stack() {
  alignas(16) static char bytes[kHandlerStackBytes];
  stack_t now{};
  if (sigaltstack(nullptr, &now) != 0 || (now.ss_flags & SS_DISABLE) == 0) return;  // it has one
  stack_t own{};
  own.ss_sp = bytes;
  own.ss_size = sizeof bytes;
  sigaltstack(&own, nullptr);
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

void set_last_act(void (*act)()) {
  last_act.store(act);
}

void send_zero(const EmergencyExit& exit) {
  const Way way{exit.descriptor.load(), exit.call.load(), exit.self.load()};
  if (way.is_there()) send_zero(way, *exit.profile, exit.writer->take_sequence());
}

void send_emergency_zeros() noexcept {
  Way ways[kMaxEmergencyExits];
  bool was_sending[kMaxEmergencyExits] = {};
  // Zero force on all devices first: safe-stop reports may take longer.
  for (int i = 0; i < kMaxEmergencyExits; ++i) {
    EmergencyExit* const exit = exits[i].load();
    if (exit == nullptr) continue;
    const std::uint32_t sequence = exit->writer->mute();
    was_sending[i] = exit->writer->is_sending();
    ways[i] = {exit->descriptor.exchange(-1), exit->call.exchange(nullptr), exit->self.load()};
    if (ways[i].is_there()) send_zero(ways[i], *exit->profile, sequence);
  }
  // A force in transmission may have arrived after that zero. If the interrupted thread is the writer itself, the wait runs
  // into its limit, once.
  const std::uint64_t until_ns = monotonic_ns() + kInFlightNs;
  for (int i = 0; i < kMaxEmergencyExits; ++i) {
    EmergencyExit* const exit = exits[i].load();
    if (exit == nullptr || !ways[i].is_there() || !was_sending[i]) continue;
    while (exit->writer->is_sending() && monotonic_ns() < until_ns)
      poll(nullptr, 0, 1);
    send_zero(ways[i], *exit->profile, exit->writer->mute());
  }
  for (int i = 0; i < kMaxEmergencyExits; ++i) {
    EmergencyExit* const exit = exits[i].load();
    if (exit == nullptr || !ways[i].is_there()) continue;
    for (int k = 0; k < exit->profile->safe_stop_count; ++k)
      write_fixed(ways[i], exit->profile->safe_stop[k]);
  }
}

void install_crash_handlers() {
  static std::atomic<bool> is_installed{false};
  if (is_installed.exchange(true)) return;
  give_handler_stack();
  std::atexit(on_exit);
  for (const int signal : kCrashSignals)
    install(signal, true);
  for (const int signal : kEndings)
    install(signal, false);
#ifdef SIGRTMIN
  for (int signal = SIGRTMIN; signal <= std::min(SIGRTMAX, kMostSignal); ++signal)
    install(signal, false);
#endif
}

}  // namespace fdcg::dev
