// SPDX-License-Identifier: Apache-2.0
// Drops duplicates of earlier faces: the same loop in either direction.
#include <algorithm>
#include <map>

#include "repair/edge_table.hpp"
#include "repair/repair.hpp"
#include "topology/duplicates.hpp"

namespace fdcg::bake {
namespace {

std::vector<VertexId> loop_of(const Mesh& mesh, FaceId f) {
  return {mesh.corners.begin() + mesh.face_first[+f], mesh.corners.begin() + mesh.face_first[+f + 1]};
}

// Whether the loops are equal up to rotation. A loop repeats few vertices, so the number of rotations to try is small.
bool is_rotation(const std::vector<VertexId>& a, const std::vector<VertexId>& b) {
  for (std::size_t start = 0; start < b.size(); ++start) {
    if (b[start] == a[0] && std::equal(b.begin() + static_cast<std::ptrdiff_t>(start), b.end(), a.begin()) &&
        std::equal(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(start), a.end() - static_cast<std::ptrdiff_t>(start)))
      return true;
  }
  return false;
}

bool is_same_loop(const std::vector<VertexId>& a, const std::vector<VertexId>& b) {
  return is_rotation(a, b) || is_rotation(a, {b.rbegin(), b.rend()});
}

// Which of the copies bound two solids that touch there, or are the back of a sheet: they run against their original, which has
// no other copy, along each of their edges as many faces run as against it, and at one there are others.
std::vector<bool> walls(const View& view, const std::vector<Duplicate>& duplicates) {
  std::vector<bool> is_wall(duplicates.size(), false);
  if (duplicates.empty()) return is_wall;
  const EdgeTable edges(view.mesh, view.states);
  std::map<FaceId, std::size_t> copies;
  for (const Duplicate& duplicate : duplicates)
    ++copies[duplicate.first];
  for (std::size_t i = 0; i < duplicates.size(); ++i) {
    const std::vector<VertexId> copy = loop_of(view.mesh, duplicates[i].copy), first = loop_of(view.mesh, duplicates[i].first);
    is_wall[i] = copies[duplicates[i].first] == 1 && is_rotation(first, {copy.rbegin(), copy.rend()});
    bool has_neighbour = false;
    for (std::size_t k = 0; k < copy.size() && is_wall[i]; ++k) {
      const EdgeTable::Count count = edges.count(copy[k], copy[(k + 1) % copy.size()]);
      is_wall[i] = count.along == count.against;
      has_neighbour = has_neighbour || count.along > 1;
    }
    is_wall[i] = is_wall[i] && has_neighbour;
  }
  return is_wall;
}

}  // namespace

std::uint64_t drop_duplicates(Workpiece& piece, Tally& tally, bool keeps_walls) {
  const View view(piece);
  tally.left.clear();
  tally.reasons.clear();
  FaceEdits edits;
  // For each first face, the distinct loops on its vertices: two polygons may visit the same vertices in different order.
  std::map<FaceId, std::vector<std::vector<VertexId>>> kept;
  const std::vector<Duplicate> duplicates = duplicate_faces(view.mesh, view.topology, view.states);
  const std::vector<bool> is_wall = keeps_walls ? walls(view, duplicates) : std::vector<bool>(duplicates.size(), false);
  for (std::size_t i = 0; i < duplicates.size(); ++i) {
    const Duplicate& duplicate = duplicates[i];
    if (is_wall[i]) continue;
    const std::vector<VertexId> loop = loop_of(view.mesh, duplicate.copy);
    std::vector<std::vector<VertexId>>& loops = kept[duplicate.first];
    if (loops.empty()) loops.push_back(loop_of(view.mesh, duplicate.first));
    if (std::any_of(loops.begin(), loops.end(), [&](const auto& other) { return is_same_loop(loop, other); })) {
      edits.emplace_back(+duplicate.copy, std::vector<std::vector<std::uint32_t>>{});
      tally.done.push_back(piece.source_face[+duplicate.copy]);
    } else {
      loops.push_back(loop);
      tally.leave(piece.source_face[+duplicate.copy], "through the vertices of an earlier polygon in another order");
    }
  }
  replace_faces(piece, edits);
  return edits.size();
}

RepairAction drop_duplicates_action(const Workpiece& piece, Tally& tally) {
  return action_of(piece, "drop-duplicates", Kind::faces,
                   counted(tally.done.size(), "face was", "faces were") + " dropped: on the vertices of an earlier one", tally);
}

}  // namespace fdcg::bake
