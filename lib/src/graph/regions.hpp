// SPDX-License-Identifier: Apache-2.0
// Grouping of triangles into planar regions that share one plane.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "base/quantum.hpp"
#include "exact/planes.hpp"
#include "fdcg/bake.hpp"
#include "graph/classify.hpp"

namespace fdcg::bake {

// Two or more triangles that share one plane bit for bit.
struct Region {
  Plane plane;              // at storage precision
  bool is_exact = false;    // all its corners are exactly coplanar
  Flat tier = Flat::exact;  // the loosest tier that was needed
  // Set for parts of a region that was split by materials: parts of one region have the same number and plane. kNone: not
  // split.
  std::uint32_t whole = kNone;
  std::uint16_t material = PolygonSoup::kNoMaterial;
};

struct Regions {
  std::vector<std::uint32_t> of_face;  // of each face: its region, or kNone for a face on its own; empty where all are
  std::vector<Region> list;

  [[nodiscard]] std::uint32_t of(FaceId f) const { return of_face.empty() ? kNone : of_face[+f]; }
};

struct RegionOptions {
  Coplanar coplanar;
  Quantum quantum;
  Precision precision = Precision::f64;
};

// Joins triangles across flat edges (classify.hpp) into regions, each bounded by the whole region's plane:
//   exact     every corner is exactly coplanar with every other. Exactly flat edges never lie between two regions.
//   quantum   every corner is within kQuantumReach of the region's largest quantum of the plane, and every normal agrees
//   angle     as quantum, or every normal is within the angle of the plane's normal
// so that small angles cannot accumulate along a chain. By the quantum no face is joined to others at a tip, a vertex where
// even so more than FDCG_BUSY_FAN planes would meet: towards it faces become narrower than the quantum, and a plane that is off
// by as much would be none of theirs (contact-model GRAPH-5). Every edge runs along the plane (planes.hpp) and every triangle
// has, exactly, positive orientation in the projection along the plane's axis. Regions grow from the largest atoms first;
// growth stops where the fitted plane would leave a member out of tolerance. Near linear; without flat edges, one pass over the
// edges. Triangles only.
[[nodiscard]] Regions find_regions(const Mesh& mesh, const Topology& topology, const std::vector<EdgeClass>& edges,
                                   const RegionOptions& options);

}  // namespace fdcg::bake
