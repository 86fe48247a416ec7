// SPDX-License-Identifier: Apache-2.0
// A closed mesh of triangles in four times as many, towards the smooth surface that it stands for.
#pragma once

#include "fdcg/bake.hpp"

namespace fdcg::test {

// C. Loop, Smooth subdivision surfaces based on triangles (1987): a vertex moves to 1 - n b of itself and b of its n
// neighbours, b = (5/8 - (3/8 + cos(2 pi/n)/4)^2)/n; an edge's new one is 3/8 of its ends and 1/8 of the corners across from
// it. At edges with other than two faces: the middle, and their ends stay.
bake::PolygonSoup loop_refined(const bake::PolygonSoup& soup);

}  // namespace fdcg::test
