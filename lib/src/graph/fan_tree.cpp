// SPDX-License-Identifier: Apache-2.0
#include "graph/fan_tree.hpp"

#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"
#include "fdcg/format.h"

namespace fdcg::bake {
namespace {

std::vector<std::uint32_t> level_sizes(std::uint32_t entries) {
  std::vector<std::uint32_t> sizes{(entries + FDCG_LEAF_FAN - 1) / FDCG_LEAF_FAN};
  while (sizes.back() > 1)
    sizes.push_back((sizes.back() + 1) / 2);
  return sizes;
}

// Unit length, or the fallback where the vector is too short to have a direction.
Vec3 direction_or(const Vec3& v, const Vec3& fallback) {
  const double size = length(v);
  return size > 1e-12 ? (1 / size) * v : fallback;
}

Vec3 perpendicular_to(const Vec3& v) {
  const int k = dominant_axis(v);
  return direction_or(k == 0 ? Vec3{-v.y, v.x, 0} : k == 1 ? Vec3{0, -v.z, v.y} : Vec3{v.z, 0, -v.x}, {1, 0, 0});
}

struct Frame {
  Vec3 axis[3];
};

// Axes along the chord of the directions, across it in the plane in which they curve, and normal to that plane. For the fan of
// a cone's apex the last one is the cone's axis: the box is thin along it, and the bound for a force along it is tight.
Frame fitted_frame(std::span<const FanDirection> fan) {
  Vec3 turning;
  for (std::size_t i = 0; i + 1 < fan.size(); ++i)
    turning = turning + cross(fan[i].edge - fan[0].edge, fan[i + 1].edge - fan[0].edge);
  const Vec3 out = direction_or(turning, perpendicular_to(fan[0].edge));
  const Vec3 chord = fan.back().edge - fan.front().edge;
  const Vec3 along = direction_or(chord - dot(chord, out) * out, perpendicular_to(out));
  const Vec3 across_out = direction_or(along - dot(along, out) * out, along);  // again: of a chord along `out` little was left
  return {across_out, cross(out, across_out), out};
}

// The largest a.u over the directions u of one entry: its edge, the next, and the arc between them in the face's plane.
double support(const FanDirection& entry, const Vec3& next_edge, const Vec3& a) {
  double most = dot(a, entry.edge);
  if (entry.face_normal == Vec3{}) return most;
  most = std::max(most, dot(a, next_edge));
  const Vec3 in_plane = a - dot(a, entry.face_normal) * entry.face_normal;
  const bool is_left_of_first = dot(cross(entry.face_normal, entry.edge), in_plane) > 0;
  const bool is_right_of_next = dot(cross(next_edge, entry.face_normal), in_plane) > 0;
  return is_left_of_first && is_right_of_next ? std::max(most, length(in_plane)) : most;
}

class FanTreeBuilder {
 public:
  FanTreeBuilder(std::span<const FanDirection> fan, double epsilon) : fan_(fan), epsilon_(epsilon) {}

  FanBox box(std::size_t first, std::size_t last) const {
    std::vector<FanDirection> directions(fan_.begin() + static_cast<std::ptrdiff_t>(first),
                                         fan_.begin() + static_cast<std::ptrdiff_t>(last));
    if (directions.back().face_normal != Vec3{}) directions.push_back({next_edge(last - 1), {}});
    const Frame frame = fitted_frame(directions);
    FanBox b;
    for (int k = 0; k < 3; ++k) {
      const Vec3& axis = frame.axis[k];
      double high = -2, low = 2;
      for (std::size_t i = first; i < last; ++i) {
        high = std::max(high, support(fan_[i], next_edge(i), axis));
        low = std::min(low, -support(fan_[i], next_edge(i), -axis));
      }
      b.centre = b.centre + (0.5 * (low + high)) * axis;
      b.axis[k] = (0.5 * (high - low) + slack(first, last)) * axis;
    }
    return b;
  }

 private:
  const Vec3& next_edge(std::size_t i) const { return fan_[i + 1 < fan_.size() ? i + 1 : 0].edge; }

  // Margin for rounding, and for edges that lie off the plane of their face (inexact nodes).
  double slack(std::size_t first, std::size_t last) const {
    double most = 0;
    for (std::size_t i = first; i < last; ++i) {
      most = std::max(
          {most, std::fabs(dot(fan_[i].face_normal, fan_[i].edge)), std::fabs(dot(fan_[i].face_normal, next_edge(i)))});
    }
    return 2 * most + 4 * epsilon_;
  }

  std::span<const FanDirection> fan_;
  double epsilon_;
};

}  // namespace

std::uint32_t fan_box_count(std::uint32_t fan_entries) {
  if (fan_entries <= FDCG_BUSY_FAN) return 0;
  std::uint32_t sum = 0;
  for (const std::uint32_t size : level_sizes(fan_entries))
    sum += size;
  return sum;
}

std::vector<FanBox> build_fan_tree(std::span<const FanDirection> fan, double epsilon) {
  const std::vector<std::uint32_t> sizes = level_sizes(static_cast<std::uint32_t>(fan.size()));
  const FanTreeBuilder builder(fan, epsilon);
  std::vector<FanBox> boxes;
  for (std::size_t level = sizes.size(); level-- > 0;) {
    const std::size_t entries_per_box = std::size_t{FDCG_LEAF_FAN} << level;
    for (std::size_t first = 0; first < fan.size(); first += entries_per_box) {
      boxes.push_back(builder.box(first, std::min(first + entries_per_box, fan.size())));
    }
  }
  return boxes;
}

}  // namespace fdcg::bake
