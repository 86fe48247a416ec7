// SPDX-License-Identifier: Apache-2.0
// Which triangles form one planar region and share one plane.
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
  // Cut from a region of several materials: pieces of one whole share this number, and the plane. kNone: it is whole.
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
// so that chains of small angles cannot drift; every edge runs along the plane (planes.hpp) and every triangle faces the
// plane's way, exactly, seen along its axis. Largest parts first; a region whose plane would move off one of its corners by
// growing on stops there. Near linear; a mesh without flat edges costs one pass over them. Triangles only.
[[nodiscard]] Regions find_regions(const Mesh& mesh, const Topology& topology, const std::vector<EdgeClass>& edges,
                                   const RegionOptions& options);

}  // namespace fdcg::bake
