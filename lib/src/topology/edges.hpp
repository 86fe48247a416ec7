// SPDX-License-Identifier: Apache-2.0
// Odd edges (those without a pair of opposite half-edges), and the fans around vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// An undirected edge that the topology marks kSameWay (two half-edges) or kNonManifold (more).
struct OddEdge {
  std::vector<HalfedgeId> halfedges;  // in slot order
};

// All odd edges, ordered by their first half-edge. Linear where there are none, else k log k in their half-edges.
[[nodiscard]] std::vector<OddEdge> odd_edges(const Mesh& mesh, const Topology& topology, unsigned jobs = 1);

// Vertices whose sound faces form more than one fan, ascending. Faces belong to one fan when an edge at the vertex, or a chain
// of such edges, joins them, however many faces the edge has. Linear; a vertex with odd edges costs k log k.
[[nodiscard]] std::vector<VertexId> vertices_of_several_fans(const Mesh& mesh, const Topology& topology,
                                                             const std::vector<FaceState>& states);

// A corner of a sound face at one of the given vertices, and the fan around that vertex to which it belongs.
struct FanCorner {
  VertexId vertex;
  HalfedgeId slot;
  std::uint32_t fan;  // 0 for that of the vertex's first corner, then in the order of their first corners
};

// All such corners, by vertex and then by slot. Linear, and k log k for the corners found.
[[nodiscard]] std::vector<FanCorner> fans_at(const Mesh& mesh, const std::vector<FaceState>& states,
                                             const std::vector<VertexId>& vertices);

}  // namespace fdcg::bake
