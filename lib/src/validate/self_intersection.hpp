// SPDX-License-Identifier: Apache-2.0
// Exact detection of pairs of faces that intersect other than in a shared vertex or edge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "exact/triangle_contact.hpp"
#include "topology/face_geometry.hpp"

namespace fdcg::bake {

struct MeetingFaces {
  FaceId a{kNone}, b{kNone};  // a < b
  Contact contact = Contact::none;
  Vec3 point;  // a common point that is no shared vertex, rounded; in the mesh's frame
};

struct SelfIntersections {
  std::uint64_t crossing = 0;        // pairs whose interiors have a common point; copies of a face are such pairs
  std::uint64_t touching = 0;        // pairs that meet only in the boundary of one of them
  std::vector<MeetingFaces> listed;  // the first of both, in ascending order
  bool has_more = false;             // the search ended at its limit; the counts and the list are of what it had found
};

// Pairs of triangles after which the search ends: of n faces on one another n^2 / 2 pairs meet.
inline constexpr std::uint64_t kMostMeetingPairs = 1'000'000;

struct SelfIntersectionOptions {
  std::size_t max_listed = kListedElements;
  unsigned jobs = 1;                   // threads; the outcome does not depend on it
  Progress progress;                   // called from one thread at a time
  const Topology* topology = nullptr;  // of the mesh: with it neighbours are told apart sooner; the outcome is the same
};

// Faces that are degenerate or not finite are ignored. A polygon is tested as the triangulation that compile uses, whose
// diagonals count as interior; one that cannot be triangulated, as the fan from its first corner. Faces that share vertices are
// tested for further common points: with one shared vertex, any other common point counts; with a shared edge, being folded
// onto each other in one plane; copies on the same vertices count. On triangle meshes the result equals CGAL's
// self_intersections without its pairs of a degenerate face with itself. About 0.2 s and 60 MB a million faces on one thread,
// plus some 100 ns a pair found. What is found before the limit does not depend on the number of threads.
[[nodiscard]] SelfIntersections find_self_intersections(const Mesh& mesh, const FaceGeometry& geometry,
                                                        const SelfIntersectionOptions& options);

}  // namespace fdcg::bake
