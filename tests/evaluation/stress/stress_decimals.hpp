// SPDX-License-Identifier: Apache-2.0
// Bodies of the stress case "decimals": bowls, boxes, grooves, wedges, fans and scans, turned, as a file of three to six
// decimals has them, in triangles: hardly any two lie in one plane, and the compiler merges those that do but for that
// rounding, or, where that is coarse, for as much of it as of a grid's.
#pragma once

#include "specimen.hpp"

namespace fdcg::test {

Body decimal_bodies(Random& random, bake::Precision precision);

}  // namespace fdcg::test
