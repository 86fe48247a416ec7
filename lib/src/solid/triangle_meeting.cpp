// SPDX-License-Identifier: Apache-2.0
// Each end of the common segment is a corner of one triangle in the other, or a point where a side of one passes through the
// other. The same end may be found from both sides; the parts in which it lies tell, without a comparison of coordinates.
#include "solid/triangle_meeting.hpp"

#include <cstddef>

#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {
namespace {

constexpr TrianglePart kOutside = 7;
using Sides = std::array<int, 3>;

bool has_corner(const Triangle3& t, std::uint32_t p) {
  return t[0] == p || t[1] == p || t[2] == p;
}

Sides sides_of_plane(std::span<const Vec3> points, const Triangle3& plane, const Triangle3& of) {
  Sides sides{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!has_corner(plane, of[i]))
      sides[i] = exact::orient3d(points[plane[0]], points[plane[1]], points[plane[2]], points[of[i]]);
  }
  return sides;
}

// The part of the triangle at which three signs, those of a place against its sides, are: all alike or zero.
TrianglePart part_at(const Sides& signs) {
  bool has_left = false, has_right = false;
  std::size_t zeros = 0, zero = 0, other = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    has_left = has_left || signs[i] > 0;
    has_right = has_right || signs[i] < 0;
    zeros += signs[i] == 0;
    (signs[i] == 0 ? zero : other) = i;
  }
  if (has_left && has_right) return kOutside;
  if (zeros == 0) return kInterior;
  if (zeros == 1) return static_cast<TrianglePart>(kFirstSide + zero);
  return static_cast<TrianglePart>((other + 2) % 3);  // on two sides: the corner across the third
}

// Of a point in the triangle's plane.
TrianglePart part_of(std::span<const Vec3> points, const Triangle3& t, std::uint32_t p) {
  for (TrianglePart i = 0; i < 3; ++i) {
    if (t[i] == p) return i;
  }
  const int axis = axis_of(points, t);
  Sides signs{};
  for (std::size_t i = 0; i < 3; ++i)
    signs[i] = exact::orient2d(points[t[i]], points[t[(i + 1) % 3]], points[p], axis);
  return part_at(signs);
}

// Of the place where the line from p to q, which lie on either side of the plane, passes through it.
TrianglePart part_passed(std::span<const Vec3> points, const Triangle3& t, std::uint32_t p, std::uint32_t q) {
  Sides signs{};
  for (std::size_t i = 0; i < 3; ++i)
    signs[i] = exact::orient3d(points[p], points[q], points[t[i]], points[t[(i + 1) % 3]]);
  return part_at(signs);
}

void add_end(TriangleMeeting& meeting, MeetingPoint end) {
  for (std::uint8_t i = 0; i < meeting.count; ++i) {
    if (meeting.end[i] == end) return;
  }
  if (meeting.count < 2) meeting.end[meeting.count++] = end;
}

// What the corners and sides of `of` meet in `in`. `sides`: of its corners, to the plane of `in`.
template <class Add>
void ends_from(std::span<const Vec3> points, const Triangle3& of, const Triangle3& in, const Sides& sides, const Add& add) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (sides[i] == 0) {
      const TrianglePart part = part_of(points, in, of[i]);
      if (part != kOutside) add(static_cast<TrianglePart>(i), part);
    } else if (sides[i] * sides[j] < 0) {
      const TrianglePart part = part_passed(points, in, of[i], of[j]);
      if (part != kOutside) add(static_cast<TrianglePart>(kFirstSide + i), part);
    }
  }
}

}  // namespace

TriangleMeeting meet(std::span<const Vec3> points, const Triangle3& a, const Triangle3& b) {
  TriangleMeeting meeting;
  const Sides a_sides = sides_of_plane(points, b, a), b_sides = sides_of_plane(points, a, b);
  meeting.is_coplanar = b_sides == Sides{};
  if (meeting.is_coplanar) return meeting;
  ends_from(points, a, b, a_sides, [&](TrianglePart in_a, TrianglePart in_b) { add_end(meeting, {in_a, in_b}); });
  ends_from(points, b, a, b_sides, [&](TrianglePart in_b, TrianglePart in_a) { add_end(meeting, {in_a, in_b}); });
  return meeting;
}

int axis_of(std::span<const Vec3> points, const Triangle3& t) {
  const Vec3 &p = points[t[0]], &q = points[t[1]], &r = points[t[2]];
  const int likely = dominant_axis(cross(q - p, r - p));
  for (int i = 0; i < 3; ++i) {
    const int axis = (likely + i) % 3;
    if (exact::orient2d(p, q, r, axis) != 0) return axis;
  }
  return likely;
}

}  // namespace fdcg::bake
