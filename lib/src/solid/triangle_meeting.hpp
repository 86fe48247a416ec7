// SPDX-License-Identifier: Apache-2.0
// In which corners, sides or interiors two triangles meet, exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A part of a triangle: corner 0..2, side 3..5 (from corner i - 3 to the next), or the interior.
using TrianglePart = std::uint8_t;
inline constexpr TrianglePart kFirstSide = 3, kInterior = 6;

struct MeetingPoint {
  TrianglePart in_a, in_b;
  friend bool operator==(const MeetingPoint&, const MeetingPoint&) = default;
};

struct TriangleMeeting {
  bool is_coplanar = false;           // then no points are worked out
  std::uint8_t count = 0;             // of ends: 0 apart, 1 a common point, 2 a common segment
  std::array<MeetingPoint, 2> end{};  // never of two interiors
};

// A triangle of three different points that are not collinear, by their numbers. Equal numbers are equal points, and no other
// points are equal.
using Triangle3 = std::array<std::uint32_t, 3>;

// Exact, by orientation tests of the points.
[[nodiscard]] TriangleMeeting meet(std::span<const Vec3> points, const Triangle3& a, const Triangle3& b);

// An axis along which the triangle is seen as one: that of the largest component of its normal, where rounding leaves it.
[[nodiscard]] int axis_of(std::span<const Vec3> points, const Triangle3& t);

}  // namespace fdcg::bake
