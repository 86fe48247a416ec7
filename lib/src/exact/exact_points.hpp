// SPDX-License-Identifier: Apache-2.0
// Points that are given by what meets in them, and exact predicates on them. CGAL's number types stay in the source file.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

using PointId = std::uint32_t;
using PointEdge = std::array<PointId, 2>;      // two given points
using PointTriangle = std::array<PointId, 3>;  // three given points that are not collinear

// Points as doubles ("given"), and points made of them. Of a made point an approximation with a bound on its error is kept, and
// its definition; its coordinates as fractions are worked out where the approximation does not decide, and kept from then on.
// One thread at a time. A predicate takes some 20 ns, or some microseconds where fractions are needed.
class ExactPoints {
 public:
  explicit ExactPoints(std::vector<Vec3> given);
  ~ExactPoints();
  ExactPoints(const ExactPoints&) = delete;
  ExactPoints& operator=(const ExactPoints&) = delete;

  PointId add(const Vec3& given);
  // Where the line through an edge meets the plane of a triangle that is not parallel to it.
  PointId on_plane(const PointEdge& line, const PointTriangle& plane);
  // Where three planes meet, whose normals are independent.
  PointId on_planes(const PointTriangle& a, const PointTriangle& b, const PointTriangle& c);
  // Where two lines of one plane meet, which are not parallel when seen along the axis.
  PointId on_lines(const PointEdge& a, const PointEdge& b, int axis);
  // The mean of three points, given or made.
  PointId middle(PointId a, PointId b, PointId c);

  [[nodiscard]] std::uint32_t count() const;
  // Each coordinate within error(p) of the exact one; of a given point the point itself.
  [[nodiscard]] const Vec3& near(PointId p) const;
  [[nodiscard]] double error(PointId p) const;

  // The orientation of a, b, c seen along an axis: exact::orient2d.
  [[nodiscard]] int orient2d(PointId a, PointId b, PointId c, int axis) const;
  // Lexicographic: -1, 0, +1.
  [[nodiscard]] int compare(PointId a, PointId b) const;
  // Along one axis.
  [[nodiscard]] int compare(PointId a, PointId b, int axis) const;
  // The side of the plane of three given points on which p lies: exact::orient3d.
  [[nodiscard]] int side(const PointTriangle& plane, PointId p) const;

 private:
  struct Exact;
  std::unique_ptr<Exact> exact_;
};

}  // namespace fdcg::bake
