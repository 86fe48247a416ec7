// SPDX-License-Identifier: Apache-2.0
// The points in which triangles meet, made once each.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "exact/exact_points.hpp"
#include "solid/triangle_meeting.hpp"

namespace fdcg::bake {

// A line in the plane of a triangle: through two given points, or where another triangle's plane meets it.
struct SupportLine {
  static constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;
  PointEdge edge{};
  std::uint32_t triangle = kNoTriangle;
  [[nodiscard]] bool is_edge() const { return triangle == kNoTriangle; }
};

class MeetingPoints {
 public:
  // Corners are numbers of given points. Both must live as long.
  MeetingPoints(ExactPoints& points, const std::vector<Triangle3>& triangles) : points_(points), triangles_(triangles) {}

  // The end of a meeting of the triangles a and b.
  PointId at(std::uint32_t a, std::uint32_t b, const MeetingPoint& end);
  // Where two lines in the plane of a triangle cross, which are not parallel when seen along the axis.
  PointId crossing(std::uint32_t triangle, const SupportLine& a, const SupportLine& b, int axis);

  [[nodiscard]] ExactPoints& points() { return points_; }
  [[nodiscard]] const Triangle3& triangle(std::uint32_t t) const { return triangles_[t]; }

 private:
  using Key = std::array<std::uint32_t, 4>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  PointId of_edge_and_plane(PointEdge edge, std::uint32_t triangle);
  PointId of_edges(PointEdge a, PointEdge b, int axis);
  PointId of_planes(std::array<std::uint32_t, 3> triangles);

  ExactPoints& points_;
  const std::vector<Triangle3>& triangles_;
  std::unordered_map<Key, PointId, Hash> made_;
};

}  // namespace fdcg::bake
