// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "base/quantum.hpp"
#include "validate/check_rules.hpp"
#include "validate/t_junctions.hpp"

namespace fdcg::bake::checks {

void non_manifold_edge(const Subject& subject, Findings& out) {
  for (const OddEdge& edge : subject.odd) {
    if (edge.halfedges.size() > 2) out.at_edge(edge.halfedges);
  }
}

void winding_inconsistent(const Subject& subject, Findings& out) {
  for (const OddEdge& edge : subject.odd) {
    if (edge.halfedges.size() == 2) out.at_edge(edge.halfedges);
  }
}

namespace {

// Corners of faces that are not finite: edges end there because of that, which another rule tells. Empty: there is none.
std::vector<bool> corners_of_faces_not_finite(const Subject& subject) {
  std::vector<bool> is_corner;
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (subject.geometry.is_finite(FaceId{f}) || subject.states[f] == FaceState::invalid_corner) continue;
    is_corner.resize(subject.mesh.points.size(), false);
    for (std::uint32_t h = subject.mesh.face_first[f]; h < subject.mesh.face_first[f + 1]; ++h)
      is_corner[+subject.mesh.corners[h]] = true;
  }
  return is_corner;
}

}  // namespace

void boundary_edge(const Subject& subject, Findings& out) {
  const std::vector<bool> is_told = corners_of_faces_not_finite(subject);
  for (std::uint32_t h = 0; h < subject.topology.twin.size(); ++h) {
    if (subject.topology.twin[h] != Topology::kBoundary) continue;
    const HalfedgeId edge{h};
    if (!is_told.empty() && (is_told[+subject.start_of(edge)] || is_told[+subject.end_of(edge)])) continue;
    out.at_edge(std::array{edge});
  }
}

void t_junction(const Subject& subject, Findings& out) {
  const Quantum quantum = quantum_of(subject.soup, subject.mesh, subject.precision);
  for (const TJunction& found : find_t_junctions(subject.mesh, subject.topology, subject.states, quantum))
    out.in_edge(found.vertex, found.edge);
}

void folded_edge(const Subject& subject, Findings& out) {
  const Mesh& mesh = subject.mesh;
  const Topology& topology = subject.topology;
  std::vector<std::array<HalfedgeId, 2>> folds;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
      const HalfedgeId twin = topology.twin[h];
      if (+twin >= +Topology::kSkipped || +twin < h) continue;
      if (subject.geometry.is_fold(FaceId{f}, HalfedgeId{h}, topology.face(twin), twin)) folds.push_back({HalfedgeId{h}, twin});
    }
  }
  for (const OddEdge& edge : subject.odd) {
    if (edge.halfedges.size() != 2) continue;
    const HalfedgeId a = edge.halfedges[0], b = edge.halfedges[1];
    if (subject.geometry.is_fold(topology.face(a), a, topology.face(b), b)) folds.push_back({a, b});
  }
  std::sort(folds.begin(), folds.end());
  for (const auto& edge : folds)
    out.at_edge(edge);
}

}  // namespace fdcg::bake::checks
