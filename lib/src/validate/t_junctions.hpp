// SPDX-License-Identifier: Apache-2.0
// Vertices that lie inside a boundary edge of another face: the seam looks closed, but its sides are not connected in the
// graph.
#pragma once

#include <vector>

#include "base/mesh.hpp"
#include "base/quantum.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

struct TJunction {
  VertexId vertex;
  HalfedgeId edge;  // the first boundary half-edge that has it inside
};

// Ascending by vertex. Vertex v of a sound face lies inside the boundary edge from p to q, of a face without it, when it is
// within reach of the segment and farther than that from p and q; reach is kQuantumReach times the quantum of p or q, whichever
// is larger. A v exactly on the line through p and q is within reach (tested exactly). Finite vertices only.
// Linear in the mesh; b boundary edges with n vertices in their cells of a coarse grid cost about (b + n) log n, since a tree
// of the vertices is searched along each edge, and found vertices are removed from it.
[[nodiscard]] std::vector<TJunction> find_t_junctions(const Mesh& mesh, const Topology& topology,
                                                      const std::vector<FaceState>& states, const Quantum& quantum);

}  // namespace fdcg::bake
