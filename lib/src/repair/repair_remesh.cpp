// SPDX-License-Identifier: Apache-2.0
// Rebuilds the surface where cutting it exactly cannot be sure what it encloses.
#include <algorithm>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "repair/level_set.hpp"
#include "repair/repair.hpp"
#include "repair/take_over.hpp"
#include "topology/face_triangles.hpp"

namespace fdcg::bake {

RepairAction remesh_step(Workpiece& piece, double voxel, bool as_floats, unsigned jobs, const Progress& progress,
                         SolidEffect& effect) {
  const View view(piece);
  const FaceGeometry geometry(view.mesh, view.states);
  const FaceTriangles cut(view.mesh, geometry, 1);
  TriangleSet triangles;
  std::vector<std::uint32_t> sources;
  for (std::uint32_t t = 0; t < cut.count(); ++t) {
    if (!geometry.is_finite(cut.face(t)) || geometry.is_degenerate(cut.face(t))) continue;
    const VertexId* const c = cut.corners(t);
    triangles.push_back({view.mesh.points[+c[0]], view.mesh.points[+c[1]], view.mesh.points[+c[2]]});
    sources.push_back(piece.source_face[+cut.face(t)]);
  }
  LevelSet made = level_set_surface(triangles, voxel, resolve_jobs(jobs), progress);
  Tally tally;
  if (made.outcome != LevelSet::Outcome::done) {
    tally.left = piece.source_face;
    RepairAction action = action_of(piece, "solid", Kind::faces, "the surface was left as it is", tally);
    action.is_refused = true;
    action.left_message = made.outcome == LevelSet::Outcome::too_fine
                              ? "no solid was made: more than " + std::to_string(kMostLatticePoints) +
                                    " lattice points at a voxel of " + in_digits(voxel) + "; give a larger --voxel"
                              : "no solid was made: nothing is enclosed, at a voxel of " + in_digits(voxel);
    return action;
  }
  for (Facet& facet : made.set.facets)
    facet.source = sources[facet.source];
  std::stable_sort(made.set.facets.begin(), made.set.facets.end(),
                   [](const Facet& s, const Facet& t) { return s.source < t.source; });
  for (Vec3& p : made.set.points) {
    p = p + view.mesh.origin;
    if (as_floats) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }
  take_over(piece, made.set);
  effect.is_solid = true;
  tally.done = piece.source_face;
  return action_of(piece, "solid", Kind::faces,
                   "the surface was rebuilt from its winding number with a voxel of " + in_digits(voxel) + ", as " +
                       std::to_string(piece.source_face.size()) + " triangles: what is smaller is lost, edges are blunted",
                   tally);
}

}  // namespace fdcg::bake
