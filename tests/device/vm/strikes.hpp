// SPDX-License-Identifier: Apache-2.0
// The faults: each does its harm once, at the moment it is called, stays long enough for what follows to be seen, and says what
// must have come of it. The device is being felt when it begins.
#pragma once

#include "rig.hpp"

namespace fdcg::vm {

struct Expectation {
  // When the host could first know; 0: it need not notice.
  Nanoseconds known = 0;
  // The host's word cannot reach the device: its own watchdog takes the force away, counted from the last output it took.
  bool is_by_watchdog = false;
  // Disarmed, and no force until it is armed again. Otherwise force comes back by itself.
  bool disarms = false;
  // Neither is asked for.
  bool may_disarm = false;
  Nanoseconds oldest_answer =
      10 * kMillisecond;  // a force may answer a report so old: the gate's silence, and what the wire adds
  std::string broken;     // what else has gone wrong; empty: nothing
};

struct StrikeKind {
  const char* name;
  Expectation (*strike)(Rig&);
  const char* told_as = nullptr;      // the host's reasons for disarming, comma-separated; null: not asked
  const char* rejected_as = nullptr;  // the host's counter that must grow; null: none must
  bool has_float_axes = false, is_log_small = false, has_clock_shim = false, has_watchdog = true;
};

// On the wire: strikes_wire.cpp.
Expectation strike_short(Rig& rig);
Expectation strike_long(Rig& rig);
Expectation strike_garbled(Rig& rig);
Expectation strike_repeated(Rig& rig);
Expectation strike_out_of_order(Rig& rig);
Expectation strike_stale(Rig& rig);
Expectation strike_nan(Rig& rig);
Expectation strike_stalled(Rig& rig);
Expectation strike_half_lost(Rig& rig);
Expectation strike_lag_5(Rig& rig);
Expectation strike_lag_15(Rig& rig);
Expectation strike_lag_30(Rig& rig);

// On the device or the host: strikes_ends.cpp.
Expectation strike_unplugged(Rig& rig);
Expectation strike_other_description(Rig& rig);
Expectation strike_no_output(Rig& rig);
Expectation strike_restarted(Rig& rig);
Expectation strike_other_host(Rig& rig);
Expectation strike_asleep(Rig& rig);
Expectation strike_clock_jump(Rig& rig);
Expectation strike_suspended(Rig& rig);
Expectation strike_killed(Rig& rig);
Expectation strike_disk_full(Rig& rig);

// On the host program: strikes_program.cpp. A crash ends it by the signal, an end in order.
template <int number>
Expectation strike_crash(Rig& rig);
template <int number>
Expectation strike_end(Rig& rig);
Expectation strike_stopped(Rig& rig);
Expectation strike_killed_unwatched(Rig& rig);
Expectation strike_servo_thread(Rig& rig);
Expectation strike_writer_thread(Rig& rig);
Expectation strike_second_program(Rig& rig);
Expectation strike_node_twice(Rig& rig);
Expectation strike_graph(Rig& rig);

inline constexpr Nanoseconds kWatchdog = 20 * kMillisecond;  // of the device

}  // namespace fdcg::vm
