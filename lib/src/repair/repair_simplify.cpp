// SPDX-License-Identifier: Apache-2.0
// The simplification step: simplify(), with a check of the whole result before it is accepted.
#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include "base/parallel.hpp"
#include "repair/repair.hpp"
#include "repair/simplify.hpp"
#include "topology/face_geometry.hpp"
#include "topology/orient.hpp"
#include "validate/self_intersection.hpp"

namespace fdcg::bake {
namespace {

// Invariants of simplification.
struct Shape {
  std::uint64_t components = 0, boundary_loops = 0;
  std::int64_t euler_characteristic = 0;
  bool is_manifold = false;
  std::uint64_t outward = 0, inward = 0;  // closed patches, by the sign of their volume

  [[nodiscard]] bool has_topology_of(const Shape& other) const {
    return components == other.components && boundary_loops == other.boundary_loops &&
           euler_characteristic == other.euler_characteristic && is_manifold == other.is_manifold;
  }
  [[nodiscard]] bool has_sides_of(const Shape& other) const { return outward == other.outward && inward == other.inward; }
};

// For a mesh whose vertices have one fan each: every border vertex has one outgoing border edge.
std::uint64_t count_boundary_loops(const Mesh& mesh, const Topology& topology) {
  std::vector<std::uint32_t> next_of(mesh.points.size(), kNone);
  for (std::uint32_t h = 0; h < topology.twin.size(); ++h) {
    if (topology.twin[h] == Topology::kBoundary)
      next_of[+mesh.corners[h]] = +mesh.corners[+next(mesh, topology.face(HalfedgeId{h}), HalfedgeId{h})];
  }
  std::uint64_t loops = 0;
  for (std::uint32_t v = 0; v < next_of.size(); ++v) {
    if (next_of[v] == kNone) continue;
    ++loops;
    for (std::uint32_t w = v; w != kNone;)
      w = std::exchange(next_of[w], kNone);
  }
  return loops;
}

Shape shape_of(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states) {
  Shape shape;
  const Patches patches = find_patches(mesh, topology, states);
  shape.components = patches.components;
  for (const Patch& patch : patches.patches) {
    shape.outward += patch.volume_sign > 0;
    shape.inward += patch.volume_sign < 0;
  }
  std::vector<bool> is_used(mesh.points.size(), false);
  for (const VertexId v : mesh.corners)
    is_used[+v] = true;
  std::uint64_t halfedges = 0, borders = 0;
  for (const HalfedgeId twin : topology.twin)
    (twin == Topology::kBoundary ? borders : halfedges)++;
  shape.euler_characteristic = std::count(is_used.begin(), is_used.end(), true) -
                               static_cast<std::int64_t>(halfedges / 2 + borders) +
                               static_cast<std::int64_t>(mesh.face_count());
  shape.is_manifold = simplify_obstacle(mesh, topology, states).empty();
  if (shape.is_manifold) shape.boundary_loops = count_boundary_loops(mesh, topology);
  return shape;
}

// The mesh of the remaining faces.
Mesh reduced(const Mesh& mesh, const Simplified& simplified, std::vector<std::uint32_t>& face_of) {
  Mesh result;
  result.points = mesh.points;
  result.origin = mesh.origin;
  result.source_point = mesh.source_point;
  result.face_first.push_back(0);
  face_of.clear();
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (simplified.corners[3 * f] == Simplified::kGone) continue;
    for (std::uint32_t k = 0; k < 3; ++k)
      result.corners.push_back(VertexId{simplified.corners[3 * f + k]});
    result.face_first.push_back(static_cast<std::uint32_t>(result.corners.size()));
    face_of.push_back(f);
  }
  return result;
}

SelfIntersections meetings(const Mesh& mesh, unsigned jobs) {
  const FaceGeometry geometry(mesh, face_states(mesh));
  SelfIntersectionOptions how;
  how.max_listed = kAllElements;
  how.jobs = jobs;
  return find_self_intersections(mesh, geometry, how);
}

std::uint64_t total(const SelfIntersections& found) {
  return found.crossing + found.touching;
}

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(std::begin(text), std::end(text), value).ptr};
}

FaceEdits edits_of(const Workpiece& piece, const Mesh& mesh, const Simplified& simplified) {
  FaceEdits edits;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t* const corner = &simplified.corners[3 * f];
    if (corner[0] == Simplified::kGone) {
      edits.push_back({f, {}});
      continue;
    }
    // Remaining corners keep their point of the soup; OpenMesh may have rotated the loop.
    std::vector<std::uint32_t> loop;
    bool is_changed = false;
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t point = mesh.source_point[corner[k]];
      bool is_old = false;
      for (std::uint32_t c = 3 * f; c < 3 * f + 3; ++c) {
        if (+mesh.corners[c] != corner[k]) continue;
        point = piece.soup.corners[c];
        is_old = true;
      }
      is_changed |= !is_old;
      loop.push_back(point);
    }
    if (is_changed) edits.push_back({f, {loop}});
  }
  return edits;
}

}  // namespace

RepairAction simplify_step(Workpiece& piece, double error, unsigned jobs, const Progress& progress) {
  const View view(piece);
  const Mesh& mesh = view.mesh;
  RepairAction action;
  action.name = "simplify";
  const auto leave = [&](const std::string& why) {
    action.message = "the mesh was left as it is";
    action.is_refused = true;
    action.left = mesh.face_count();
    action.left_message = "the mesh was not simplified: " + why;
    return action;
  };
  if (const std::string obstacle = simplify_obstacle(mesh, view.topology, view.states); !obstacle.empty()) {
    Tally tally;
    tally.left = piece.source_face;
    action.left_elements = action_of(piece, "simplify", Kind::faces, "", tally).left_elements;
    return leave(obstacle + ", after the other repairs; it takes triangles only, manifold and wound alike");
  }

  const Shape before = shape_of(mesh, view.topology, view.states);
  const std::uint64_t meetings_before = total(meetings(mesh, resolve_jobs(jobs)));
  std::vector<bool> is_locked(mesh.points.size(), false);
  std::optional<Simplified> simplified;
  constexpr int kRounds = 8, kLocking = 3;
  double tried = error;
  std::uint64_t more = 0;
  bool is_turned = false;
  for (int round = 0; round < kRounds; ++round) {
    simplified = simplify(mesh, tried, is_locked, progress);
    if (!simplified) return leave("its connectivity does not fit OpenMesh");
    std::vector<std::uint32_t> face_of;
    const Mesh result = reduced(mesh, *simplified, face_of);
    const std::vector<FaceState> states = face_states(result);
    const Shape after = shape_of(result, pair_halfedges(result, states), states);
    if (!after.has_topology_of(before)) return leave("its topology would have changed");
    is_turned = !after.has_sides_of(before);
    if (is_turned) {  // with an error bound near the size of a part, its faces may turn over in many small steps
      tried /= 2;
      continue;
    }
    const SelfIntersections found = meetings(result, resolve_jobs(jobs));
    more = total(found) > meetings_before ? total(found) - meetings_before : 0;
    if (more == 0) break;
    // Locks the surroundings of intersecting faces. If that is not enough, sheets are closer than the error, which is halved.
    if (round >= kLocking) tried /= 2;
    for (const MeetingFaces& pair : found.listed) {
      for (const FaceId f : {pair.a, pair.b}) {
        for (std::uint32_t k = 0; k < 3; ++k) {
          is_locked[+result.corners[3 * +f + k]] = true;
          is_locked[+mesh.corners[3 * face_of[+f] + k]] = true;
        }
      }
    }
  }
  if (is_turned) return leave("a closed part of it would have turned inside out, or lost its volume");
  if (more != 0) return leave(counted(more, "pair", "pairs") + " of its faces would have met that do not meet now");

  Tally tally;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (simplified->corners[3 * f] == Simplified::kGone) tally.done.push_back(piece.source_face[f]);
  }
  const std::string message = std::to_string(mesh.face_count()) + " faces became " +
                              std::to_string(mesh.face_count() - simplified->gone) +
                              "; neither surface has a point farther than " + number(error) + " from the other";
  const FaceEdits edits = edits_of(piece, mesh, *simplified);
  action = action_of(piece, "simplify", Kind::faces, message, tally);
  replace_faces(piece, edits);
  return action;
}

}  // namespace fdcg::bake
