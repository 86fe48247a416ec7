// SPDX-License-Identifier: Apache-2.0
// What fdcg-servo run says of its devices: lines for people, JSON lines for programs (schemas/servo-status.schema.json).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fdcg/device_tools.hpp"

namespace fdcg::servo {

using dev::DeviceLook;

// Of an fdcg_state: "face".
const char* state_name(std::uint32_t state);
// Quantiles in microseconds: as an object, and as "p50 1, p99 2, p99.9 3, max 4 us\n" ("-\n": none).
nlohmann::ordered_json times_json(const dev::TimeHistogram& histogram);
std::string times_text(const dev::TimeHistogram& histogram);
// "right hand   armed       1000/s  face    1.23 N  lost 0, rejected 0, late 0"; no line end. `name_width`: of the column.
std::string status_line(const DeviceLook& look, std::size_t name_width);
// One object; no line end. `event`: "status" or "end".
std::string status_json(const char* event, double seconds, const std::vector<DeviceLook>& looks,
                        const std::string& log_failure);
// Some lines a device: what it did and how long it took.
std::string summary_text(const std::vector<DeviceLook>& looks);

// Something went wrong: not kNone, and not the user's own doing.
bool is_trouble(dev::Fault fault);
std::uint64_t rejected_in_all(const dev::TickCounters& counters);

}  // namespace fdcg::servo
