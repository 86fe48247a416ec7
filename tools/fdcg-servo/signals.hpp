// SPDX-License-Identifier: Apache-2.0
// What signals do to fdcg-servo run while it drives devices.
//
//   SIGINT, SIGTERM, SIGHUP   the host is asked to stop: zero force, in order
//   SIGTSTP, SIGTTIN          the devices are disarmed at once, since a stopped process sends nothing; then kept until take_stop()
//   SIGPIPE, SIGXFSZ, SIGTTOU ignored: a reader that goes away, or a file limit, is an error where it is written; output of a
//                             background job is let through
//   a crash, and every other  zero force as the last act of the process, which dies of the signal (emergency.hpp)
//   that ends a process
#pragma once

#include "fdcg/device_tools.hpp"

namespace fdcg::servo {

// One at a time. Made in the main thread, after the scene is opened and before the host's threads run.
class Signals {
 public:
  explicit Signals(dev::SceneRun* host);
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  // The signal that asked for the process to be stopped since the last call; 0: none.
  int take_stop();
  // Stops the process by that signal, as its default action does. Returns when it is continued.
  void stop_process(int signal);
};

}  // namespace fdcg::servo
