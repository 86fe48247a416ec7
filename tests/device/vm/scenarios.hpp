// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rig.hpp"

namespace fdcg::vm {

// Every fault `times` times, at random moments, and what came of it. only: names, comma-separated; empty: all.
void run_faults(const RigOptions& options, int times, const std::string& only, Verdicts& verdicts);

// `seconds` of being felt: nothing late, nothing lost, every report answered in time.
void run_timing(const RigOptions& options, int seconds, Verdicts& verdicts);

}  // namespace fdcg::vm
