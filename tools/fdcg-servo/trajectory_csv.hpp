// SPDX-License-Identifier: Apache-2.0
// The recorded path of a hand (schemas/trajectory-log.md).
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fdcg::servo {

struct TrajectoryPoint {
  double t_s = 0;
  std::array<double, 3> hip_object_m{};  // NaN and infinities pass: a recorded fault is replayed as the step will meet it
};

// Reads CSV text whose first line names at least t, x, y and z; other columns are ignored. On failure returns false and `error`
// is one line that names `name`, the line (1-based), the value and what is wrong with it.
bool parse_trajectory(std::string_view text, const std::string& name, std::vector<TrajectoryPoint>& points, std::string& error);

// The same for a file or a pipe; - is standard input.
bool read_trajectory(const std::string& path, std::vector<TrajectoryPoint>& points, std::string& error);

}  // namespace fdcg::servo
