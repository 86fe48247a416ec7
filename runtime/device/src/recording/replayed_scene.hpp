// SPDX-License-Identifier: Apache-2.0
// The scene of a replayed tick: where its objects are, and what its contacts touch.
#pragma once

#include <vector>

#include "recording/session_replay.hpp"

namespace fdcg::dev {

struct ReplayedTouch {
  const fdcg_touch* touch;
  int contact;
};
// Contact by contact.
std::vector<ReplayedTouch> touches_of(const DeviceSetup& setup);

// Where an object was in that tick.
const fdcg_pose& tick_pose(const HostConfig& config, const ReplayedTick& tick, std::size_t object);

// World, unit: of the face of a graph (a soft object's apart) or of the sphere that is touched. False: the touch is elsewhere.
bool touched_normal(const SessionReplay& replay, const ReplayedTick& tick, const fdcg_touch& touch, double normal[3]);

}  // namespace fdcg::dev
