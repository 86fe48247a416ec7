// SPDX-License-Identifier: Apache-2.0
// A replayed session as CSV: a row a good report (schemas/session-log.md), and a row for each touch of each contact.
#pragma once

#include <string>

#include "recording/session_replay.hpp"

namespace fdcg::dev {

// Header lines end with a newline. Columns of bodies by their objects' names, where a comma or a quote would be is a '_'.
std::string session_csv_header(const HostConfig& config);
std::string session_csv_row(const ReplayedTick& tick, std::uint64_t first_ns);

std::string touches_csv_header();
// Any number of rows; none where nothing is touched.
std::string touches_csv_rows(const SessionReplay& replay, const ReplayedTick& tick, std::uint64_t first_ns);

}  // namespace fdcg::dev
