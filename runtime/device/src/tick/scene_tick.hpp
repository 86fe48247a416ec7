// SPDX-License-Identifier: Apache-2.0
// The scene's part of a tick: moves the fingers to the tips, steps bodies and sheets, computes the force of every finger. For
// one device, or for several that share the scene:
//
// - The clock device is the fastest one that sends reports; of equal ones the first in the scene. If it had a good report in
// this
//   tick, the scene advances by one period of it, otherwise not at all. A silent clock device is replaced after
//   kMissedTicksToFade periods.
// - The fingers of the other devices are at the positions of their newest reports.
// - A device's fingers are removed from the scene when it is lost, has sent no good report for kSilenceS, or was disarmed by a
//   fault. They are added again, without contacts, at the hand's position: after a fault when the device is armed again,
//   otherwise with the next good report. Objects that they held fall unless other fingers hold them. Without a fault (not armed
//   yet, disarmed by command, an unknown limit) they stay: a hand that gets no force still moves what it presses.
//
// No heap, no lock, no clock.
#pragma once

#include "tick/device_tick.hpp"

namespace fdcg::dev {

// Where a device's tip is in the world.
void to_world(const Mapping& mapping, const double device_m[3], double world_m[3]);
// Adds the device's fingers to its scene, at a tip of zero. In a shared scene they are removed again, until the first report.
// False with *error where the scene refuses them.
bool begin_fingers(DeviceState* device, fdcg_error* error);

// After the reports of this tick have been taken in (last_good_ns, tip_m, grip). has_moved: by member, whether a good report
// with a place came in. Returns the clock. Sets each device's wanted_n and state.
int scene_tick(const Member* members, int count, const bool* has_moved);
// After the gates' step: the fingers of those that are gone, silent or disarmed by a fault leave. Of shared scenes only.
void leave_scene(const Member& member);

}  // namespace fdcg::dev
