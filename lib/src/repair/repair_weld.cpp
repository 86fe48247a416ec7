// SPDX-License-Identifier: Apache-2.0
// Merges vertices in the soup: each group is stored once, at the position of its first vertex.
#include <cstddef>

#include "repair/repair.hpp"
#include "topology/weld.hpp"

namespace fdcg::bake {
namespace {

// The points of the soup that were merged into another.
std::vector<std::uint32_t> joined_points(const Mesh& mesh, std::size_t points) {
  std::vector<std::uint32_t> joined;
  std::uint32_t v = 0;
  for (const std::uint32_t standing : mesh.source_point) {  // ascending
    for (; v < standing; ++v)
      joined.push_back(v);
    ++v;
  }
  for (; v < points; ++v)
    joined.push_back(v);
  return joined;
}

std::uint64_t count_repeated_corners(const std::vector<FaceState>& states) {
  std::uint64_t count = 0;
  for (const FaceState state : states)
    count += state == FaceState::repeated_corner;
  return count;
}

}  // namespace

RepairAction weld_step(Workpiece& piece, const Weld& weld) {
  PolygonSoup& soup = piece.soup;
  Tally tally;
  piece.identity = {Weld::Kind::none, 0};
  if (weld.kind == Weld::Kind::none)
    return action_of(piece, "weld", Kind::vertices, "no vertex was joined: those of the file were judged as they are", tally);

  const std::uint64_t repeated_before = count_repeated_corners(View(piece).states);
  const Mesh mesh = weld_points(soup, weld, Precision::f64);
  tally.done = joined_points(mesh, soup.points.size());
  const std::uint64_t points = soup.points.size();
  for (std::size_t v = 0; v < mesh.source_point.size(); ++v)
    soup.points[v] = soup.points[mesh.source_point[v]];  // source_point is ascending: none is overwritten before it is read
  soup.points.resize(mesh.source_point.size());
  piece.source_point = mesh.source_point;
  for (std::size_t c = 0; c < soup.corners.size(); ++c)
    soup.corners[c] = +mesh.corners[c];  // kNone is kInvalidVertex

  std::string message = counted(tally.done.size(), "vertex was", "vertices were") + " joined to an earlier one" +
                        (weld.kind == Weld::Kind::exact ? " at equal coordinates" : " within the distance") + ", of " +
                        std::to_string(points);
  const std::uint64_t repeated = count_repeated_corners(face_states(mesh)) - repeated_before;
  if (repeated != 0) message += "; " + counted(repeated, "face has", "faces have") + " lost a corner by that";
  return action_of(piece, "weld", Kind::vertices, message, tally);
}

}  // namespace fdcg::bake
