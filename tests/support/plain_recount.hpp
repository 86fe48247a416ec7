// SPDX-License-Identifier: Apache-2.0
// An independent count of the rules on meshes of any size and coordinates, by definition: maps and searches over edges, CGAL's
// exact predicates for geometry. n log n, except inside-out (rays against every face) and t-junction (every boundary edge
// against every vertex).
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::test {

struct PlainRecount {
  std::map<std::string, std::uint64_t> totals;  // rules with a total of zero are absent
  std::uint64_t vertices = 0, components = 0, kept_faces = 0;
  // Polygons certainly off their plane, and those that are not certainly flat: the tolerance lies between.
  std::uint64_t least_non_planar = 0, most_non_planar = 0;
};

// Of the welded mesh, in double. Leaves out self-intersection, non-planar-face (see above) and, where `seams` is not set,
// t-junction.
PlainRecount plain_recount(const bake::PolygonSoup& soup, bool seams);

}  // namespace fdcg::test
