// SPDX-License-Identifier: Apache-2.0
// Patches: sets of sound faces connected across edges of exactly two faces; their enclosed volume, and whether their winding is
// or can be made consistent.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "topology/edges.hpp"
#include "topology/face_geometry.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

struct Patch {
  FaceId first_face{kNone};
  std::uint32_t faces = 0;
  bool is_closed = true;       // no boundary edge and no edge of more than two faces
  bool is_consistent = true;   // no edge along which two faces run in the same direction
  bool is_orientable = true;   // flipping some of its faces would make it consistent
  bool is_finite = true;       // all corners are
  HalfedgeId conflict{kNone};  // not orientable: a half-edge at which the contradiction was found
  int volume_sign = 0;         // exact; only of closed, consistent, finite patches, else 0. Polygons as fans of triangles

  [[nodiscard]] bool encloses() const { return is_closed && is_consistent && is_finite && volume_sign != 0; }
};

struct Patches {
  std::vector<Patch> patches;           // in the order of their first faces
  std::vector<std::uint32_t> of_face;   // the patch of each face, or kNone where it is not sound
  std::vector<std::uint8_t> is_turned;  // of each face: runs against the first face of its orientable patch. Empty: none
  std::uint64_t components = 0;         // faces of every kind, joined by a shared vertex
};

// Near linear. `geometry` belongs to the mesh as it is.
[[nodiscard]] Patches find_patches(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states,
                                   const std::vector<OddEdge>& odd, const FaceGeometry& geometry);

// Nesting depth: for each patch of `asked` the number of other enclosing patches in which it lies. Exact ray casting from one
// of its vertices (parity, orientation tests on the stored points, symbolic perturbation). If that vertex lies on another patch
// the next one is tried, up to a bound, after which patches that contain the point do not count. Sorts the faces once, then
// about log(faces) per patch.
[[nodiscard]] std::vector<std::uint32_t> nesting_depths(const Mesh& mesh, const Patches& patches,
                                                        const std::vector<std::uint32_t>& asked);

// The patches, ascending, that enclose negative volume at an even nesting depth, where they should bound a solid.
[[nodiscard]] std::vector<std::uint32_t> inside_out_patches(const Mesh& mesh, const Patches& patches);

}  // namespace fdcg::bake
