// SPDX-License-Identifier: Apache-2.0
// Whether a corner of a solid, or an edge or a face there, is where a god-object without friction may rest, from the source
// triangles alone. Of a corner, the directions that leave it without entering the solid are a cone, and none of them may lead
// nearer to the HIP. Written apart from the step: no Voronoi planes, no search by features, and at a corner the one decision
// that rounding could turn is made in exact numbers.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "hip_walk.hpp"

namespace fdcg::test {

class Descent {
 public:
  // Of a closed surface without self-intersection.
  explicit Descent(const std::vector<std::array<Hip, 3>>& triangles);

  // How far the best edge or face of the solid at `corner` leads towards the HIP: the length of HIP - corner along it; 0 where
  // every one leads away. In long double.
  [[nodiscard]] double reach(const Hip& corner, const Hip& hip) const;

  // Whether the straight way from the corner to the HIP begins outside the solid or on its surface. Exact.
  [[nodiscard]] bool begins_outside(const Hip& corner, const Hip& hip) const;

  // Whether a god-object so near to `place` may rest on an edge or a face at `corner`: at the foot of the HIP, from where no
  // way that does not enter the solid leads nearer, were the HIP moved by no more than that. In long double.
  [[nodiscard]] bool rests_beside(const Hip& corner, const Hip& place, double so_near, const Hip& hip) const;

 private:
  using Wing = std::pair<Hip, Hip>;  // a triangle at the corner: its other two points, counter-clockwise from outside
  [[nodiscard]] const std::vector<Wing>& fan_at(const Hip& corner) const;

  std::map<Hip, std::vector<Wing>> fans_;
};

}  // namespace fdcg::test
