// SPDX-License-Identifier: Apache-2.0
// Mesh simplification with a proved bound on the distance to the original surface.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// Largest angle between the normals of a face before and after, in degrees.
inline constexpr double kMostTurnDegrees = 60;

struct Simplified {
  static constexpr std::uint32_t kGone = 0xFFFFFFFFu;

  std::vector<std::uint32_t> corners;  // three of each face, numbered as before: vertices of the mesh; kGone where it is gone
  std::uint32_t gone = 0;
};

// Why the mesh cannot be simplified: the first face that is not a valid triangle with an area, edge that has neither one face
// nor two consistently wound ones, or vertex with several fans. Empty: it can be simplified.
[[nodiscard]] std::string simplify_obstacle(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states);

// Collapses edges onto one of their ends, cheapest first by quadric error (Garland and Heckbert 1997; OpenMesh's Decimater), as
// long as
//   the surface keeps its topology: each collapse passes the link condition, and border vertices stay on their border
//   the Hausdorff distance to the original surface is at most `error`: proved for each collapse by SurfaceCover, for every
//   triangle that it changes and every original triangle that these replace
//   no face turns by more than kMostTurnDegrees from the original, and none loses its area
// Remaining vertices do not move; those marked in `is_locked` are not removed. Some 10 to 100 microseconds per collapse, and
// 300 bytes per face. Precondition: the check above finds no obstacle. Units: those of the mesh. Nothing where OpenMesh cannot
// hold the mesh.
[[nodiscard]] std::optional<Simplified> simplify(const Mesh& mesh, double error, const std::vector<bool>& is_locked,
                                                 const Progress& progress);

}  // namespace fdcg::bake
