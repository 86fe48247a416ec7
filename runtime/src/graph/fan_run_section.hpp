// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

// Section FAN_RUNS of a graph whose other sections are sound: runs in order and apart, each node of one at its busy corner;
// FDCG_OK where the file has none. Cost: linear in the runs' nodes.
fdcg_status verify_fan_runs(const fdcg_graph& graph, fdcg_error* error);

}  // namespace fdcg
