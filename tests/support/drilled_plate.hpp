// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meshes.hpp"

namespace fdcg::test {

// A plate of 2 x 2 x 0.3 with a round hole of radius 0.5, as CAD tessellates it: from each corner of the plate needles go to a
// quarter of the hole. `around`: corners of the hole, a multiple of 4.
PolygonSoup drilled_plate(int around);

}  // namespace fdcg::test
