// SPDX-License-Identifier: Apache-2.0
// Splits non-manifold vertices: each fan of faces around a vertex gets its own vertex. No edge changes its faces, since those
// of one edge are in one fan at both of its ends.
#include "repair/repair.hpp"
#include "topology/edges.hpp"

namespace fdcg::bake {

RepairAction split_vertices_step(Workpiece& piece) {
  const View view(piece);  // identity none: its vertices are the soup's points
  PolygonSoup& soup = piece.soup;
  const std::vector<VertexId> several = vertices_of_several_fans(view.mesh, view.topology, view.states);
  const std::uint32_t before = static_cast<std::uint32_t>(soup.points.size());
  std::uint32_t first_of_vertex = before;  // the point of fan 1 of the vertex
  VertexId vertex{kNone};
  for (const FanCorner& corner : fans_at(view.mesh, view.states, several)) {
    if (corner.vertex != vertex) first_of_vertex = static_cast<std::uint32_t>(soup.points.size());
    vertex = corner.vertex;
    if (corner.fan == 0) continue;  // fan 0 keeps the vertex, as do faces in no fan
    const std::uint32_t point = first_of_vertex + corner.fan - 1;
    if (point == soup.points.size()) {
      soup.points.push_back(Vec3(soup.points[+vertex]));
      piece.source_point.push_back(piece.source_point[+vertex]);
    }
    soup.corners[+corner.slot] = point;
  }
  Tally tally;
  for (const VertexId v : several)
    tally.done.push_back(piece.source_point[+v]);
  std::string message = counted(several.size(), "vertex was", "vertices were") + " split, one for each fan of faces";
  const std::uint64_t fresh = soup.points.size() - before;
  if (fresh != 0)
    message += ": " + counted(fresh, "new vertex", "new vertices") +
               " at the same coordinates, kept apart only by a reader that does not weld";
  return action_of(piece, "split-non-manifold-vertices", Kind::vertices, message, tally);
}

}  // namespace fdcg::bake
