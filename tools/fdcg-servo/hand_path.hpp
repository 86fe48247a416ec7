// SPDX-License-Identifier: Apache-2.0
// A path of a hand for any graph: it comes down on the object, presses, slides there and back, and lifts off.
#pragma once

#include <string>
#include <vector>

#include "fdcg/fdcg.h"
#include "trajectory_csv.hpp"

namespace fdcg::servo {

// At 1 kHz, in the object's frame, by the graph's bounds alone: 10 s on the surface and some more to come and to go. The hand
// looks at the object along its direction of view (turned by 25 degrees about y, tilted by 12), presses with a depth of about
// 0.5 % of the object's size against a surface without friction, and slides over a quarter of the size. The same graph gives
// the same points. Empty with *problem where nothing is touched.
std::vector<TrajectoryPoint> slide_path(const fdcg_graph& graph, std::string* problem);

// As --trajectory reads it, with 17 significant digits.
std::string trajectory_csv(const std::vector<TrajectoryPoint>& points);

}  // namespace fdcg::servo
