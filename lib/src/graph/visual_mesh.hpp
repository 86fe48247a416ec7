// SPDX-License-Identifier: Apache-2.0
// The mesh for the eye, of the sections VISUAL_*: the triangles as they were before faces were merged.
#pragma once

#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/visual.h"
#include "graph/graph.hpp"
#include "graph/triangulate.hpp"

namespace fdcg::bake {

struct VisualMesh {
  std::vector<fdcg_visual_vertex> vertices;     // draw_triangles(): one a slot, `corner` is the vertex of the mesh
  std::vector<std::uint32_t> indices;           // three a triangle
  std::vector<std::uint32_t> nodes;             // of each triangle
  std::vector<fdcg_visual_material> materials;  // draw_triangles(): all of the soup and one for faces without, no runs yet
  std::vector<std::uint16_t> material;          // of each triangle, until share_vertices()

  [[nodiscard]] bool is_empty() const { return vertices.empty(); }
};

// Every corner of every triangle with what the soup says of it.
[[nodiscard]] VisualMesh draw_triangles(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face,
                                        const Triangulation& cut, const CompileOptions& options);

// Puts the triangles in order, by material and then by node, and joins corners that agree in everything. `face_of_triangle`: of
// the mesh that the graph was made of; empty: the same number. The graph names vertices. Materials without triangles are
// dropped.
void share_vertices(VisualMesh& visual, const Graph& graph, const std::vector<std::uint32_t>& face_of_triangle);

}  // namespace fdcg::bake
