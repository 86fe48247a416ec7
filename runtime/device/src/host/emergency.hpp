// SPDX-License-Identifier: Apache-2.0
// Zero force when a signal ends the process: a crash (crash_signals.hpp, and std::terminate, which aborts), or a signal whose
// default action is termination; and when somebody calls exit() while devices are open. For each open device the writer is
// muted, then a report of zero force and the profile's safe-stop reports are sent, by write(2) on a file descriptor that was
// opened beforehand, or by a call of the transport's own (serial lines, plugins); then the process ends as it would have.
// hidapi does not expose its descriptor; hidraw can be opened a second time, libusb cannot: there, and after kill -9, only the
// device's watchdog removes the force, which is why a device without one gets little force (gate.hpp). A device that takes no
// output may delay the end of the process by 5 s per report.
#pragma once

#include <atomic>

#include "host/writer.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

struct EmergencyExit {
  std::atomic<int> descriptor{-1};                                       // -1: none, now
  std::atomic<void (*)(void*, const std::uint8_t*, int)> call{nullptr};  // null: none, now
  std::atomic<void*> self{nullptr};                                      // of the call; set before it
  const Profile* profile = nullptr;
  Writer* writer = nullptr;
};

// Registers a device, for all hosts of the process. False: kMaxEmergencyExits are in use, and this one is not served. Not in a
// signal handler.
inline constexpr int kMaxEmergencyExits = 64;
bool add_emergency_exit(EmergencyExit* exit);
void remove_emergency_exit(EmergencyExit* exit);

// Installs the handlers, once per process, with an alternate signal stack for the calling thread (threads of the host have
// their own). They handle every crash signal and pass it on to the previous handler; of the other signals that end a process by
// default, those that are neither handled nor ignored at the time of the call. A host does not install them by itself, since
// signal handlers belong to the program (fdcg-servo run installs them).
void install_crash_handlers();

// Called once by the handlers when every device has its zero, before the process dies: async-signal-safe. Null: nothing is.
void set_last_act(void (*act)());

// One report of zero force by the device's emergency descriptor or call, if it has one. May block as a write does.
void send_zero(const EmergencyExit& exit);

// The action of the handlers; async-signal-safe. Descriptors are used once. A report that a writer was sending meanwhile is
// followed by a second zero report.
void send_emergency_zeros() noexcept;

}  // namespace fdcg::dev
