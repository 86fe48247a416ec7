// SPDX-License-Identifier: Apache-2.0
// Ticks as JSON (schemas/servo-snapshot.schema.json), for dashboards and recordings.
#pragma once

#include <string>
#include <vector>

#include "fdcg/device.h"

namespace fdcg::servo {

// What snapshots number, by name.
struct SnapshotNames {
  std::vector<std::string> devices, objects, bodies;
};

// The newest of every device; null: it has none yet.
std::string snapshots_json(const SnapshotNames& names, const std::vector<const fdcg_snapshot*>& newest, double seconds,
                           bool is_recording);
// One tick of one device, on a line.
std::string tick_json(const SnapshotNames& names, std::size_t device, const fdcg_snapshot& tick);
// What was said, as an event.
std::string said_json(double seconds, const std::string& text);

}  // namespace fdcg::servo
