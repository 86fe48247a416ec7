// SPDX-License-Identifier: Apache-2.0
// Resolves intersections into the outer surface, and leaves out what encloses nothing or lies inside.
#include <algorithm>

#include "base/parallel.hpp"
#include "repair/boundary_loops.hpp"
#include "repair/repair.hpp"
#include "repair/take_over.hpp"
#include "solid/outer_surface.hpp"
#include "topology/face_triangles.hpp"
#include "topology/orient.hpp"

namespace fdcg::bake {
namespace {

// The facets of the faces that are in no part with a hole. `open`: sources of the others.
FacetSet closed_facets(const Workpiece& piece, std::vector<std::uint32_t>& open) {
  const View view(piece);
  const FaceGeometry geometry(view.mesh, view.states);
  const FaceTriangles cut(view.mesh, geometry, 1);
  const Patches patches = find_patches(view.mesh, view.topology, view.states);
  std::vector<bool> is_open(patches.patches.size(), false);
  for (const BoundaryLoop& loop : boundary_loops(view.mesh, view.topology)) {
    const std::uint32_t patch = patches.of_face[+loop.faces[0]];
    if (!loop.is_slit && patch != kNone) is_open[patch] = true;
  }
  for (std::uint32_t f = 0; f < view.mesh.face_count(); ++f) {
    const std::uint32_t patch = patches.of_face[f];
    if (patch != kNone && is_open[patch]) open.push_back(piece.source_face[f]);
  }
  std::vector<Facet> facets;
  for (std::uint32_t t = 0; t < cut.count(); ++t) {
    const FaceId f = cut.face(t);
    const std::uint32_t patch = patches.of_face[+f];
    if (patch == kNone || is_open[patch]) continue;
    Facet facet;
    for (std::size_t i = 0; i < 3; ++i)
      facet.corner[i] = view.mesh.source_point[+cut.corners(t)[i]];
    facet.source = piece.source_face[+f];
    facets.push_back(facet);
  }
  return gathered(piece.soup.points, std::move(facets));
}

std::string why_not(OuterSurface::Outcome outcome) {
  switch (outcome) {
    case OuterSurface::Outcome::too_many_pairs:
      return "more than a million pairs of faces meet; --solid=remesh rebuilds such a surface";
    case OuterSurface::Outcome::not_closed:
      return "its faces do not close up, after the other repairs; --solid=remesh rebuilds such a surface";
    case OuterSurface::Outcome::not_settled:
      return "rounding to the numbers of the file brought intersections back in every round; --solid=remesh rebuilds it";
    case OuterSurface::Outcome::fault:
      return "by a fault of this program, which please report; --solid=remesh does without what failed";
    case OuterSurface::Outcome::done:
      break;
  }
  return "its faces enclose nothing, as those of a sheet do not";
}

std::string account_of(const OuterSurface& outer) {
  std::string text = counted(outer.pairs, "pair of faces that met was", "pairs of faces that met were") +
                     " resolved into the outer surface, " + counted(outer.cut, "face was cut", "faces were cut") + "; of " +
                     counted(outer.inner.size(), "face", "faces") +
                     " nothing is left, since they lay inside or enclosed nothing";
  if (outer.met_again != 0) {
    text += "; rounding brought back " + counted(outer.met_again, "pair", "pairs") + ", resolved in " +
            counted(static_cast<std::uint64_t>(outer.rounds), "round", "rounds");
  }
  return text;
}

}  // namespace

RepairAction solid_step(Workpiece& piece, bool as_floats, unsigned jobs, const Progress& progress, SolidEffect& effect) {
  Tally tally;
  FacetSet set = closed_facets(piece, tally.left);
  for (std::size_t i = 0; i < tally.left.size(); ++i)
    ++tally.reasons["in parts with an open hole, which enclose nothing and were left out"];
  OuterSurface outer = outer_surface(std::move(set), {as_floats, resolve_jobs(jobs), progress});
  RepairAction action;
  if (outer.outcome != OuterSurface::Outcome::done || outer.set.facets.empty()) {
    Tally all;
    all.left = piece.source_face;
    action = action_of(piece, "solid", Kind::faces, "the surface was left as it is", all);
    action.is_refused = true;
    action.left_message = "no solid was made: " + why_not(outer.outcome);
    return action;
  }
  take_over(piece, outer.set);
  effect.distance = outer.moved;
  effect.is_solid = true;
  tally.done = outer.inner;
  action = action_of(piece, "solid", Kind::faces, account_of(outer), tally);
  action.total = outer.pairs + outer.inner.size();
  return action;
}

}  // namespace fdcg::bake
