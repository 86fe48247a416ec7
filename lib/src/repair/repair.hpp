// SPDX-License-Identifier: Apache-2.0
// The steps of repair(), one file each: repair_weld, repair_degenerate, repair_duplicates, repair_split, repair_winding.
//
// A step makes only safe repairs: except for a weld by distance, the surface as a set of points stays the same, no edge gets
// more faces, and no hole or seam opens. Defects that cannot be repaired safely are counted as left, with the reason.
#pragma once

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
std::uint64_t drop_duplicates(Workpiece& piece, Tally& tally);
RepairAction drop_duplicates_action(const Workpiece& piece, Tally& tally);

// The workpiece is welded: its identity is none.
RepairAction split_vertices_step(Workpiece& piece);
RepairAction orient_step(Workpiece& piece);
RepairAction reverse_inside_out_step(Workpiece& piece);
// All or nothing: if after several tries the result still has another topology, or more intersecting pairs of faces, the mesh
// is left unchanged.
RepairAction simplify_step(Workpiece& piece, double error, unsigned jobs, const Progress& progress);

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

}  // namespace fdcg::bake
