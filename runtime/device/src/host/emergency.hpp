// SPDX-License-Identifier: Apache-2.0
// The last word of a process that a signal ends: a crash (crash_signals.hpp, and std::terminate, which aborts), or a signal
// whose default action is the process' end. On each open device the writer is muted, then a report of zero force and the
// profile's safe-stop reports go out by write(2) on a file descriptor that was opened beforehand; then the process dies of its
// signal. hidapi hides its own descriptor; hidraw can be opened once more, libusb cannot: there, and after kill -9, only the
// device's watchdog takes the force away, which is why a device without one gets little force (gate.hpp). A device that takes
// no output may hold the process for 5 s a report.
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

// Handlers, once a process, and a stack of its own for them in the calling thread (threads of the host have theirs). They are
// taken for every signal of a crash, and pass it on to whatever handled it before; of the other signals that end a process by
// default, for those that nobody handles or ignores at the time of the call. A host does not install them by itself: they
// belong to the process, so to the program (fdcg-servo run does).
void install_crash_handlers();

// What the handlers do; async-signal-safe. Open descriptors are used once. A report that a writer was sending meanwhile is
// followed by another zero.
void send_emergency_zeros() noexcept;

}  // namespace fdcg::dev
