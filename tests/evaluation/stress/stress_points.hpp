// SPDX-License-Identifier: Apache-2.0
// Bodies of the stress case "points": cones, needles, crowns, rings and rows of needles of 100 to 10,000 sides.
#pragma once

#include "specimen.hpp"

namespace fdcg::test {

Body pointed_bodies(Random& random, bake::Precision precision);

}  // namespace fdcg::test
