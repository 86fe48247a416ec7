// SPDX-License-Identifier: Apache-2.0
// All that can be seen of a tick (fdcg_snapshot), for programs and dashboards.
#pragma once

#include "fdcg/device.h"
#include "tick/device_tick.hpp"

namespace fdcg::dev {

// After the tick, in the thread that made it. seconds: since the start. Contacts and bodies beyond the counts are not touched:
// a device has as many in each tick, and a cache line that is not touched costs nothing. No heap, no lock; cost linear in
// contacts and bodies.
void take_snapshot(const DeviceState& device, const TickOutput& output, std::uint64_t tick, double seconds, fdcg_snapshot* to);

}  // namespace fdcg::dev
