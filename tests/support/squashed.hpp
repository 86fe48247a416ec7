// SPDX-License-Identifier: Apache-2.0
// Bodies that are far from round: what holds at corners whose faces and edges are all of one size may fail at others.
#pragma once

#include "meshes.hpp"

namespace fdcg::test {

// Apexes at z = 1 and z = -1 over and under a ring of n points of hashed radius and height: two corners of n faces, convex,
// concave and saddles as it comes. A closed solid whatever the seed.
PolygonSoup double_fan(int n, std::uint64_t seed);

// One coordinate (0, 1, 2) multiplied by a factor: below 1 the body is flat, above 1 long.
PolygonSoup stretched(const PolygonSoup& soup, int axis, double factor);

}  // namespace fdcg::test
