// SPDX-License-Identifier: Apache-2.0
// Whether a finger can have touched an object in this tick: two conservative tests (no false negatives), with the bounding
// sphere relative to its moving centre, and with the bounding box in the object's frame.
#pragma once

#include "scene/pose.hpp"

namespace fdcg {

// The distance of a straight way from the origin, squared.
inline double way_distance2(World from, World to) {
  const World way = to - from;
  const double length2 = dot(way, way);
  double t = length2 > 0 ? -dot(from, way) / length2 : 0;
  t = t < 0 ? 0 : (t > 1 ? 1 : t);
  const World nearest = from + way * t;
  return dot(nearest, nearest);
}

inline World absolute(World a) {
  return {absolute(a.x), absolute(a.y), absolute(a.z)};
}

// Whether a straight way meets the box |x| <= half; by separating axes (Ericson 2005, section 5.3.3).
inline bool way_meets_box(World from, World to, World half) {
  constexpr double kRounding = 16 * RealLimits<double>::kEpsilon;
  const World middle = (from + to) * 0.5, along = (to - from) * 0.5;
  const World m = absolute(middle), a = absolute(along);
  const World between = half + a + m * kRounding;
  if (m.x > between.x || m.y > between.y || m.z > between.z) return false;
  const World across = absolute(cross(middle, along));
  const World most = {half.y * a.z + half.z * a.y + (m.y * a.z + m.z * a.y) * kRounding,
                      half.x * a.z + half.z * a.x + (m.x * a.z + m.z * a.x) * kRounding,
                      half.x * a.y + half.y * a.x + (m.x * a.y + m.y * a.x) * kRounding};
  return !(across.x > most.x || across.y > most.y || across.z > most.z);
}

// The distance of a point from the box |x| <= half.
inline double box_distance(World x, World half) {
  const World a = absolute(x);
  const World out = {a.x > half.x ? a.x - half.x : 0, a.y > half.y ? a.y - half.y : 0, a.z > half.z ? a.z - half.z : 0};
  return norm(out);
}

}  // namespace fdcg
