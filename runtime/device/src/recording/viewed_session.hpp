// SPDX-License-Identifier: Apache-2.0
// A replayed session as fdcg/session_view.hpp has it.
#pragma once

#include "fdcg/session_view.hpp"
#include "recording/session_replay.hpp"

namespace fdcg::dev {

ViewedScene viewed_scene(const HostConfig& config);
ViewedTick viewed_tick(const SessionReplay& replay, const ReplayedTick& tick, std::uint64_t first_ns);

}  // namespace fdcg::dev
