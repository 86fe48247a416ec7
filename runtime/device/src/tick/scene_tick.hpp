// SPDX-License-Identifier: Apache-2.0
// The scene's part of a tick: fingers to where the hands are, bodies and sheets a step on, what every finger feels. Of one
// device, or of several that share the scene:
//
// - The clock is the fastest device that gives reports; of equal ones the first in the scene. Where it had a good report in
//   this tick, the scene moves on by one period of it, otherwise it stands still. A clock that falls silent is followed by
//   another after kMissedTicksToFade periods.
// - The others' fingers are where their newest reports had them.
// - A device's fingers leave the scene when it is gone, has given no good report for kSilenceS, or was disarmed by a fault:
//   they then touch nothing. They come back, free, where the hand then is: after a fault when it is armed again, otherwise with
//   the next good report. What they held is the others' to hold, or falls. Without a fault (not armed yet, disarmed by command,
//   a limit that is not known) they stay: a hand that gets no force still moves what it presses.
//
// No heap, no lock, no clock.
#pragma once

#include "tick/device_tick.hpp"

namespace fdcg::dev {

// Where a device's tip is in the world.
void to_world(const Mapping& mapping, const double device_m[3], double world_m[3]);
// Adds the device's fingers to its scene, at a tip of zero. A shared scene gets them only when there is a hand: they are taken
// out again. False with *error where the scene refuses them.
bool begin_fingers(DeviceState* device, fdcg_error* error);

// After the reports of this tick have been taken in (last_good_ns, tip_m, grip). has_moved: by member, whether a good report
// with a place came in. Returns the clock. Sets each device's wanted_n and state.
int scene_tick(const Member* members, int count, const bool* has_moved);
// After the gates' step: the fingers of those that are gone, silent or disarmed by a fault leave. Of shared scenes only.
void leave_scene(const Member& member);

}  // namespace fdcg::dev
