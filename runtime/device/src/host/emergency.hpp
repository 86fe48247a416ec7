// SPDX-License-Identifier: Apache-2.0
// The last word of a process that crashes (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, and std::terminate, which aborts): on each
// open device the writer is muted, then a report of zero force and the profile's safe-stop reports go out by write(2) on a file
// descriptor that was opened beforehand. hidapi hides its own; hidraw can be opened once more, libusb cannot: there, and after
// kill -9, only the device's watchdog takes the force away, which is why a device without one gets little force (gate.hpp).
// A device that takes no output may hold the process for 5 s a report.
#pragma once

#include <atomic>

#include "host/writer.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

struct EmergencyExit {
  std::atomic<int> descriptor{-1};  // -1: none, now
  const Profile* profile = nullptr;
  Writer* writer = nullptr;
};

// Of all hosts of the process. False: kMaxEmergencyExits are taken, and this one is not served. Not in a signal's handler.
inline constexpr int kMaxEmergencyExits = 64;
bool add_emergency_exit(EmergencyExit* exit);
void remove_emergency_exit(EmergencyExit* exit);

// Handlers for the signals above, once a process. They pass on to whatever handled a signal before. A host does not install
// them by itself: they belong to the process, so to the program (fdcg-servo does).
void install_crash_handlers();

// What the handlers do; async-signal-safe. Open descriptors are used once.
void send_emergency_zeros() noexcept;

}  // namespace fdcg::dev
