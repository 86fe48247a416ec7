// SPDX-License-Identifier: Apache-2.0
#include "path_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../common/program.hpp"
#include "../common/terminal.hpp"

namespace fdcg::servo {
namespace {

using tools::grouped;
using tools::short_number;

std::string shown_name(const std::string& name) {
  return name.empty() ? "--path" : name == "-" ? "standard input" : name;
}

}  // namespace

void warn_of_non_finite(const std::string& name, const std::vector<TrajectoryPoint>& points) {
  const auto is_bad = [](const TrajectoryPoint& point) {
    return std::any_of(point.hip_object_m.begin(), point.hip_object_m.end(), [](double x) { return !std::isfinite(x); });
  };
  const auto count = std::count_if(points.begin(), points.end(), is_bad);
  if (count == 0) return;
  const auto first = std::find_if(points.begin(), points.end(), is_bad);
  tools::warn(shown_name(name) + ": " + grouped(static_cast<std::uint64_t>(count)) + " of " + grouped(points.size()) +
              (count == 1 ? " rows has" : " rows have") +
              " a HIP that is NaN or infinite, the first at t = " + short_number(first->t_s) + " s: no force is felt there");
}

void warn_of_nothing_touched(const fdcg_graph& graph, const std::vector<TrajectoryPoint>& points, const std::string& name) {
  const fdcg_header& header = *graph.header;
  double nearest_m = std::numeric_limits<double>::infinity(), size_m = 0;
  std::string sides;
  for (int axis = 0; axis < 3; ++axis) {
    const double side = (header.bounds_max[axis] - header.bounds_min[axis]) * header.metres_per_unit;
    sides += (axis == 0 ? "" : " x ") + short_number(side);
    size_m = std::hypot(size_m, side);
  }
  for (const TrajectoryPoint& point : points) {
    double square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = point.hip_object_m[axis] / header.metres_per_unit - header.origin[axis];
      const double outside = std::max({header.bounds_min[axis] - at, at - header.bounds_max[axis], 0.0});
      square += outside * outside;
    }
    nearest_m = std::min(nearest_m, std::sqrt(square) * header.metres_per_unit);  // NaN is never nearer
  }
  if (!std::isfinite(nearest_m)) return;  // no HIP is a place, which has been warned of
  std::string text = shown_name(name) + ": the path touches nothing; it comes as near as " + short_number(nearest_m) +
                     " m to the object's box, which measures " + sides + " m";
  if (nearest_m > size_m) text += ". Both are in metres: was the mesh compiled with the right --units?";
  tools::warn(text);
}

}  // namespace fdcg::servo
