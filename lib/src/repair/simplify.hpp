// SPDX-License-Identifier: Apache-2.0
// Fewer triangles, within a distance of what they were.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// A normal may turn so far from that of the face before, in degrees.
inline constexpr double kMostTurnDegrees = 60;

struct Simplified {
  static constexpr std::uint32_t kGone = 0xFFFFFFFFu;

  std::vector<std::uint32_t> corners;  // three of each face, numbered as before: vertices of the mesh; kGone where it is gone
  std::uint32_t gone = 0;
};

// Why the mesh cannot be simplified: its first face that is no sound triangle with an area, edge that has not two faces wound
// alike or one, or vertex of several fans. Empty: it can be.
[[nodiscard]] std::string simplify_obstacle(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states);

// Collapses edges onto one of their ends, cheapest first by quadric error (Garland and Heckbert 1997; OpenMesh's Decimater), as
// long as
//   the surface keeps its topology: each collapse passes the link condition, and border vertices stay on their border
//   no point of it is farther than `error` from the surface given, and none of that from it: proved for each collapse by
//   SurfaceCover, for every triangle that it changes and every triangle given that these stand for
//   no face turns by more than kMostTurnDegrees from what it was, and none loses its area
// Vertices stay where they are; those marked in `is_locked` stay altogether. Some 10 to 100 microseconds a collapse, and 300
// bytes a face. The mesh has no obstacle. Units: those of the mesh.
// Nothing where OpenMesh cannot hold the mesh.
[[nodiscard]] std::optional<Simplified> simplify(const Mesh& mesh, double error, const std::vector<bool>& is_locked,
                                                 const Progress& progress);

}  // namespace fdcg::bake
