// SPDX-License-Identifier: Apache-2.0
// The steps of repair(), one file each: repair_weld, repair_degenerate, repair_duplicates, repair_split, repair_winding,
// repair_cut make only safe repairs: except for a weld by distance, the surface as a set of points stays the same, no edge gets
// more faces, and no hole or seam opens but where faces have nowhere to go on to. Defects that cannot be repaired safely are
// counted as left, with the reason. repair_crossing, repair_unfold and repair_drop change the surface where no graph could have
// it; what that does to it is measured (surface_distance.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// The mesh under repair.
struct Workpiece {
  explicit Workpiece(const PolygonSoup& soup);

  const PolygonSoup& input;
  PolygonSoup soup;                         // as repaired so far
  std::vector<std::uint32_t> source_point;  // of each point of `soup`: its number in the input
  std::vector<std::uint32_t> source_face;   // of each face, ascending: parts of a face that was cut share its number
  Weld identity;                            // which of its vertices are one: exact until it is welded, then none
  bool has_floats;                          // every coordinate of the input is a float: new ones are made floats too
};

// Adjacency of the workpiece. Vertices are those of Mesh, corner slots those of the soup.
struct View {
  explicit View(const Workpiece& piece);

  Mesh mesh;
  std::vector<FaceState> states;
  Topology topology;
};

// The result of a step: repaired and left faces or vertices, by their input indices. A face repaired twice is listed twice.
struct Tally {
  std::vector<std::uint32_t> done, left;
  std::map<std::string, std::uint64_t> reasons;  // of what was left

  void leave(std::uint32_t source, const std::string& reason) {
    left.push_back(source);
    ++reasons[reason];
  }
};

RepairAction weld_step(Workpiece& piece, const Weld& weld);

// May be called again when another step has changed the mesh: `done` accumulates, `left` and `reasons` are those of the last
// call. Returns the number of repairs of this call.
struct DegenerateTally : Tally {
  std::uint64_t joined = 0;  // of those: merged into the neighbour across their longest edge
  std::uint64_t closed = 0;  // of those: polygons kept after removing repeated corners and spikes
};
std::uint64_t drop_degenerate(Workpiece& piece, DegenerateTally& tally);
RepairAction drop_degenerate_action(const Workpiece& piece, DegenerateTally& tally);
// `keeps_walls`: a copy that bounds another solid than its original is kept, for cut_edges() to part the two.
std::uint64_t drop_duplicates(Workpiece& piece, Tally& tally, bool keeps_walls = false);
RepairAction drop_duplicates_action(const Workpiece& piece, Tally& tally);

// The workpiece is welded: its identity is none.
RepairAction split_vertices_step(Workpiece& piece);
RepairAction orient_step(Workpiece& piece);
RepairAction reverse_inside_out_step(Workpiece& piece);

// Faces with a corner that is not finite or that the file does not have; they are dropped, since there is no surface in them.
RepairAction drop_unusable_step(Workpiece& piece);

// Polygons that cross or touch themselves, or come twice to a corner, as triangles of the same outline: of all choices without
// a new corner the one of the least area, which for an outline that only touches itself is its inside. A flat one that crosses
// itself is parted at the crossings into outlines that do not, each with the side that its own direction gives it (the winding
// number's sign); the neighbours get the crossing as a corner.
RepairAction triangulate_crossing_step(Workpiece& piece);

// Folded pairs of triangles of which one is no thicker than `thickness`: the diagonal of the two together is exchanged, which
// leaves what they do not both cover. Flaps, a triangle and its back that reach no farther from where they hang, go. Returns
// the number of exchanges; may be called again.
struct UnfoldTally : Tally {
  double thickest = 0;  // of the slivers taken away
  std::uint64_t flaps = 0;
};
std::uint64_t unfold(Workpiece& piece, double thickness, UnfoldTally& tally);
RepairAction unfold_action(const Workpiece& piece, UnfoldTally& tally);

// See repair_cut.cpp. The workpiece is welded. May be called again.
enum CutKind : std::uint8_t { kPaired, kCrowded, kFold, kOneSided };
struct CutTally {
  struct Edge {
    std::array<std::uint32_t, 2> ends;  // input points
    std::uint32_t face;                 // of the input, one of those at the edge
  };
  std::vector<Edge> edges;
  std::array<std::uint64_t, 4> count{};  // of each kind
  std::uint64_t new_points = 0, middles = 0, turned = 0;
};
void cut_edges(Workpiece& piece, CutTally& tally);
RepairAction cut_action(const Workpiece& piece, CutTally& tally);

// Vertices at equal coordinates are apart by repair alone; a file without numbers of vertices would join them. All but one are
// moved towards the faces around them by as few floats (of float files; else doubles) as make them differ.
RepairAction part_equal_points_step(Workpiece& piece);

// Drops what validate still finds and no graph can have, as few faces of each finding as end it. Returns the number of faces
// dropped; may be called again.
std::uint64_t drop_blocking(Workpiece& piece, unsigned jobs, Tally& tally);
RepairAction drop_blocking_action(const Workpiece& piece, Tally& tally);

// All or nothing: if after several tries the result still has another topology, or more intersecting pairs of faces, the mesh
// is left unchanged.
RepairAction simplify_step(Workpiece& piece, double error, unsigned jobs, const Progress& progress);

// Borders that run along one another no farther apart than `gap`. The workpiece is welded.
struct StitchTally : Tally {
  std::uint64_t joined = 0, divided = 0;  // vertices, edges
};
RepairAction stitch_step(Workpiece& piece, double gap);

// Holes up to a size, flat or of little bending. The workpiece is welded. May be called again.
struct HoleTally : Tally {
  std::uint64_t flat = 0, fair = 0;
  double largest = 0, largest_left = 0;  // the diagonal of a hole's bounds
};
void close_holes(Workpiece& piece, double largest, HoleTally& tally);
RepairAction close_holes_action(const Workpiece& piece, HoleTally& tally);

// The outer surface of what closed parts enclose (solid/outer_surface.hpp). Parts with a hole are left out. All or nothing:
// where there is no such surface, the mesh stays. Afterwards edges may have more than two faces, where solids touch.
struct SolidEffect {
  bool is_solid = false;
  double distance = 0;  // of the surface that stays from where it was
};
RepairAction solid_step(Workpiece& piece, bool as_floats, unsigned jobs, const Progress& progress, SolidEffect& effect);
// The surface rebuilt from its winding number (level_set.hpp): closed, manifold, without intersections.
RepairAction remesh_step(Workpiece& piece, double voxel, bool as_floats, unsigned jobs, const Progress& progress,
                         SolidEffect& effect);

// ---- for the steps

// Faces of the soup, ascending, each with the loops (of points) that take its place; none: the face is dropped.
using FaceEdits = std::vector<std::pair<std::uint32_t, std::vector<std::vector<std::uint32_t>>>>;
// Points that had a face and have none afterwards are dropped too. Linear.
void replace_faces(Workpiece& piece, const FaceEdits& edits);

// Totals, lists in source order, and why some were left: "2 were left: 1 whose ..., 1 whose ...".
enum class Kind { faces, vertices };
RepairAction action_of(const Workpiece& piece, std::string name, Kind kind, std::string message, Tally& tally);

// "1 face", "12 faces"
std::string counted(std::uint64_t count, const std::string& one, const std::string& many);

// The shortest decimal of six digits at most.
std::string in_digits(double value);

}  // namespace fdcg::bake
