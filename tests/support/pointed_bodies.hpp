// SPDX-License-Identifier: Apache-2.0
// Bodies with points, about 50 mm large, and hands that come at these points: at 1 kHz and a constant speed, from outside.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hip_walk.hpp"
#include "meshes.hpp"

namespace fdcg::test {

// A closed body of triangles, in metres.
struct PointedBody {
  PolygonSoup soup;
  struct Tip {
    Hip point, outwards;  // where it is, and the axis along which it points
  };
  std::vector<Tip> tips;
};

enum class PointedKind : std::uint8_t {
  cone,    // 100 mm high, radius 25 mm
  needle,  // 40 mm high, radius 0.2 mm
  flat,    // a cone 2 mm high, radius 25 mm
  crown,   // a fan whose rim goes up and down, the tip between
  ring,    // needles of 40 sides on a circle, each leaning outwards; `sides` are those of all
  wall,    // needles of 4 sides in a row, close to one another; `sides` are those of all
};
inline constexpr PointedKind kPointedKinds[] = {PointedKind::cone,  PointedKind::needle, PointedKind::flat,
                                                PointedKind::crown, PointedKind::ring,   PointedKind::wall};
const char* name_of(PointedKind kind);

// `turn`: of the whole body about the origin.
PointedBody pointed_body(PointedKind kind, int sides, const Rotation& turn);

// How a hand comes.
enum class Approach : std::uint8_t {
  along_axis,  // exactly down the axis
  past_axis,   // along it, up to 0.1 mm beside it and a few degrees aslant
  sideways,    // across the axis, up to 2 mm below the tip
  slanting,    // from anywhere outside, at the tip to a rounding
  by_steps,    // down the axis, with a tick exactly on the tip
};
inline constexpr Approach kApproaches[] = {Approach::along_axis, Approach::past_axis, Approach::sideways, Approach::slanting,
                                           Approach::by_steps};
const char* name_of(Approach approach);

// HIPs at 1 kHz: towards the tip, some millimetres on in the same direction, and back a part of the way.
std::vector<Hip> hand_way(const PointedBody::Tip& tip, Approach approach, double metres_per_second, Random& random);

}  // namespace fdcg::test
