// SPDX-License-Identifier: Apache-2.0
// The normals of a smooth surface at the corners of its triangles, for the section NODE_NORMALS.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/format.h"
#include "graph/merge.hpp"
#include "graph/triangulate.hpp"

namespace fdcg::bake {

struct CornerNormals {
  std::vector<fdcg_node_normals> of_face;  // of each triangle; empty: every one is flat
  std::uint64_t shaded = 0;                // triangles that are not flat
  std::uint64_t unusable = 0;              // corners whose normal leans from their triangle by more than 60 degrees: flat there
};

// Of the triangles of `cut`, by options.normals: from the faces around a vertex, up to creases, or those of the mesh file. Near
// linear.
[[nodiscard]] CornerNormals find_corner_normals(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face,
                                                const Triangulation& cut, const CompileOptions& options);

// Of each slot of `cut`, of unit length, for the eye: the file's where the soup has one, else from the faces around the vertex,
// up to creases of options.crease_rad.
[[nodiscard]] std::vector<Vec3> smooth_normals(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face,
                                               const Triangulation& cut, const CompileOptions& options);

// Takes every triangle that is not flat out of its region as a piece of its own, which keeps the region's plane and is merged
// with nothing.
void split_by_normals(const CornerNormals& normals, Regions& regions);

// Those of the faces that the triangles of `cut` became. `points`: of the mesh before it was merged.
[[nodiscard]] std::vector<fdcg_node_normals> normals_of_faces(const CornerNormals& normals,
                                                              const std::vector<VertexId>& corners, const Merged& faces);

}  // namespace fdcg::bake
