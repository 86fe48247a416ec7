// SPDX-License-Identifier: Apache-2.0
// The catalogue of rules. Names and severities are promises to people's scripts: add rows, change none.
#include <algorithm>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

const std::vector<Rule>& rules() {
  using enum Severity;
  static const std::vector<Rule> kRules{
      {"unreadable", error, "files that cannot be read as a mesh", "There is nothing to touch.",
       "Check the path and the format; export the mesh again as OFF, OBJ, PLY or STL.", false},
      {"non-finite-coordinate", error,
       "vertices with a coordinate that is NaN or infinite, or too large for the precision asked",
       "Planes through such a vertex are NaN, and so is every force computed from them.",
       "Export the mesh again, or delete the vertices and the faces that use them.", false},
      {"index-out-of-range", error, "faces that name a vertex the file does not have",
       "The face has no shape; the surface has a hole where it should be.",
       "Export the mesh again; the file is likely cut short or its indices start at the wrong number.", false},
      {"empty-mesh", error, "files without a single face", "There is no surface to touch.",
       "Export faces and not only points or lines.", false},
      {"degenerate-face", error, "faces with a corner named twice, or whose corners all lie exactly on one line",
       "A face without area has no normal, so that nothing says which way it pushes; an outline that comes twice to a corner, "
       "as around a bridge to a hole, has no single inside there.",
       "Run `fdcg repair --drop-degenerate` for faces without area; triangulate polygons with holes.", false},
      {"self-crossing-face", error,
       "polygons whose outline crosses or touches itself: seen along the axis nearest to their mean normal and, if far from "
       "flat, along the others too",
       "Nothing tells which side of the outline is the face: there is no cutting it into convex pieces.",
       "Triangulate the polygon in the modelling program, or put its corners in order.", false},
      {"duplicate-face", error, "the second and later faces on the same vertices, in whatever order",
       "Contact would have two answers at one place, and the edges around it more than two faces.",
       "Run `fdcg repair --drop-duplicates`, or delete the copies.", false},
      {"non-manifold-edge", error, "edges with more than two faces",
       "Sliding over such an edge the god-object has no single face to go on to.",
       "Split the surface along the edge, or remove the inner faces.", false},
      {"non-manifold-vertex", error, "vertices whose faces form more than one fan",
       "At such a vertex separate sheets touch in a point; the faces around it have no cyclic order.",
       "Give each fan a vertex of its own: `fdcg repair --split-non-manifold-vertices` does; read its result with `--weld "
       "none`.",
       false},
      {"winding-inconsistent", error, "edges whose two faces run along them in the same direction",
       "One of the two faces looks inwards: the hand would fall through it.",
       "Compile with `--orient`, or flip the faces in the modelling program.", false},
      {"not-orientable", error, "patches, joined across edges of two faces, that no flipping can make consistent",
       "A one-sided surface such as a Moebius strip has no outside to be touched from.",
       "Cut the strip, or thicken it into a solid.", false},
      {"inside-out", error, "closed patches that enclose negative volume where they should bound solid",
       "All of their faces look inwards: one can enter freely and is held inside.",
       "Compile with `--orient`, or flip the part; `--allow inside-out` keeps it if the inside is to be touched.", true},
      {"folded-edge", error, "edges whose two faces lie exactly in one plane on the same side of the edge",
       "Nothing tells whether the edge is a knife of no thickness or a slit, so that the god-object cannot be led around it.",
       "Delete one of the two faces, or give the part a thickness.", false},
      {"boundary-edge", warning, "edges with one face",
       "The surface ends there: the hand can pass around the edge to the back, where nothing is felt.",
       "Close the hole if the object is meant to be solid; where rounding alone keeps two rims apart, `--weld DISTANCE` joins "
       "them.",
       true},
      {"self-intersection", warning, "pairs of faces that meet other than in a shared vertex or edge",
       "Inside the overlap the god-object follows one sheet and ignores the other; where faces only touch it may slip between.",
       "Unite the overlapping parts in the modelling program.", true},
      {"non-planar-face", warning, "polygons with corners off their plane by more than the rounding of the file explains",
       "A node of the graph is one plane: compile cuts such a polygon into triangles, and the cut can be felt.",
       "Triangulate the polygon where the crease should run, or flatten it.", true},
      {"t-junction", note,
       "vertices of other faces inside a boundary edge: no farther from it than four times the rounding of the file explains, "
       "and farther than that from both its ends",
       "The two sides of the seam are not connected: the god-object leaves the surface there.",
       "Split the long edge at the vertex.", true},
      {"sliver-face", note,
       "faces thinner than a thousandth of their length: the height of a triangle over its longest edge, against that edge; "
       "twice a polygon's area by its outline, against half its outline",
       "Their normals are sensitive to rounding, and crossing many of them costs steps.",
       "Remesh the region with better shaped faces.", true},
      {"isolated-vertex", note, "vertices of no face", "None: they are left out of the graph.",
       "Nothing needs to be done; delete them to make the file smaller.", true},
      {"duplicate-vertex", note, "vertices that the weld joined to an earlier one",
       "None where faces are meant to hang together; with `--weld none` every such face stands alone.",
       "Nothing needs to be done; `--weld none` keeps the vertices apart, as it must where `fdcg repair` has split a vertex.",
       true},
  };
  return kRules;
}

const Rule* find_rule(std::string_view name) {
  const auto rule = std::find_if(rules().begin(), rules().end(), [&](const Rule& r) { return r.name == name; });
  return rule == rules().end() ? nullptr : &*rule;
}

}  // namespace fdcg::bake
