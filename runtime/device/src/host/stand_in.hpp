// SPDX-License-Identifier: Apache-2.0
// A device's thread of last resort: where its writer hangs with a force sent, it sends one zero force by the device's emergency
// way (emergency.hpp). A thread of its own for each device: that write blocks too where the device takes no output, and the
// supervisor may be opening another device meanwhile.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/threads.hpp"
#include "host/emergency.hpp"
#include "host/writer.hpp"
#include "tick/link.hpp"

namespace fdcg::dev {

class StandIn {
 public:
  // All three must outlive it.
  StandIn(Writer& writer, Link& link, const EmergencyExit& emergency) : writer_(writer), link_(link), emergency_(emergency) {}

  // The thread's body, until request_stop.
  void run();
  void request_stop();
  Event& stalled() { return wake_; }  // for ServoParts

 private:
  Writer& writer_;
  Link& link_;
  const EmergencyExit& emergency_;
  Event wake_;
  std::atomic<bool> is_stopping_{false};
};

}  // namespace fdcg::dev
