// SPDX-License-Identifier: Apache-2.0
// Which faces go on into which at edges that have several: the choice that makes a mesh of any faces a surface.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/mesh.hpp"
#include "topology/edges.hpp"
#include "topology/face_geometry.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// Pairs the half-edges of an edge of more than two faces. The faces are sorted by their angle around the edge, exactly, and
// those that bound one wedge of solid are paired: first a face that turns its inside to the larger angles, then the next one
// that turns it to the smaller, innermost pairs first, as with brackets. So solids that touch along the edge become separate
// ones. Faces at one angle are taken as lying apart with nothing solid between; no pair is a fold. Where as many faces run
// along the edge as against it, all are paired; of others some are left over.
class RadialPairing {
 public:
  // `geometry` is that of the mesh. Faces that are degenerate or not finite are left over.
  RadialPairing(const Mesh& mesh, const Topology& topology, FaceGeometry& geometry);

  using Pair = std::pair<HalfedgeId, HalfedgeId>;
  [[nodiscard]] std::vector<Pair> pairs_of(const OddEdge& edge);

 private:
  struct Spoke {
    HalfedgeId halfedge;
    const Vec3* apex;  // the corner across the edge of the triangle that lies at it
    bool is_along;     // runs from the edge's first vertex to its second
    bool is_taken = false;
  };
  [[nodiscard]] const Vec3* apex_of(HalfedgeId h);
  [[nodiscard]] std::vector<Spoke> sorted_spokes(const OddEdge& edge);
  [[nodiscard]] bool can_pair(const Spoke& a, const Spoke& b);
  void cut_polygons();

  const Mesh& mesh_;
  const Topology& topology_;
  FaceGeometry& geometry_;
  bool is_cut_ = false;
  std::vector<VertexId> apex_;  // of each slot; empty where every face is a triangle
};

}  // namespace fdcg::bake
