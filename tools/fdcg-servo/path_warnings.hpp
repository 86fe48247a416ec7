// SPDX-License-Identifier: Apache-2.0
// What a replay warns of, even where it prints no summary. `name`: of the path's file, "-", or empty where it was made.
#pragma once

#include <string>
#include <vector>

#include "fdcg/fdcg.h"
#include "trajectory_csv.hpp"

namespace fdcg::servo {

// Ticks whose HIP is NaN or infinite: a recorded fault is no error, but its ticks should not be taken for free ones.
void warn_of_non_finite(const std::string& name, const std::vector<TrajectoryPoint>& points);

// After a replay that was free throughout: how near the path comes to the object's box, and how large that is.
void warn_of_nothing_touched(const fdcg_graph& graph, const std::vector<TrajectoryPoint>& points, const std::string& name);

}  // namespace fdcg::servo
