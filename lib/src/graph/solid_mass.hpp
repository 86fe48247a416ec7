// SPDX-License-Identifier: Apache-2.0
// Volume, centroid and inertia of the solid that a closed mesh encloses: exact sums, each result rounded once.
#pragma once

#include <array>
#include <string>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "graph/regions.hpp"

namespace fdcg::bake {

struct MassProperties {
  double volume = 0;                // source units
  Vec3 centroid;                    // local
  std::array<double, 6> inertia{};  // about the centroid, density 1: xx, yy, zz, xy, xz, yz; xy is minus the integral of x y
};

// Mass properties of the enclosed solid, or the reason why the mesh encloses none.
struct Solid {
  MassProperties mass;
  std::string reason;  // empty: it is a solid
};

// Of a mesh of triangles, by the divergence theorem: sums over the tetrahedra between the origin and each triangle, in integers
// on the grid of the lowest bit of any coordinate. A reason where an edge is open or runs against its neighbour, or where the
// sums are no solid's (surfaces wound the other way in parts). Space that is enclosed twice counts twice, a cavity not at all.
// Linear: 0.3 us a triangle and thread where the coordinates span 60 bits, 0.8 up to 124, from 1 on beyond. The same whatever
// `jobs`.
[[nodiscard]] Solid measure_solid(const Mesh& mesh, const Topology& topology, unsigned jobs);

// The largest distance of a corner from the plane of the region that its triangle belongs to; 0 where there are none.
[[nodiscard]] double deviation_from_regions(const Mesh& mesh, const Regions& regions);

}  // namespace fdcg::bake
