// SPDX-License-Identifier: Apache-2.0
// Unfolds slivers: of two triangles folded onto each other in one plane, u-v-a and v-u-b, where the smaller one lies in the
// larger one, the diagonal u-v is exchanged for a-b. What is left is the larger one without the smaller one, covered once. The
// neighbours of both stay neighbours.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "base/vec3.hpp"
#include "exact/exact.hpp"
#include "repair/edge_table.hpp"
#include "repair/repair.hpp"
#include "repair/surface_cover.hpp"
#include "topology/duplicates.hpp"
#include "topology/face_geometry.hpp"

namespace fdcg::bake {
namespace {

class Unfolder {
 public:
  Unfolder(Workpiece& piece, double thickness, UnfoldTally& tally)
      : piece_(piece), view_(piece), geometry_(view_.mesh, view_.states), thickness_(thickness), tally_(tally) {}

  std::uint64_t run() {
    const Mesh& mesh = view_.mesh;
    for (std::uint32_t h = 0; h < view_.topology.twin.size(); ++h) {
      const HalfedgeId twin = view_.topology.twin[h];
      if (+twin >= +Topology::kSkipped || +twin < h) continue;
      const FaceId f = view_.topology.face(HalfedgeId{h}), g = view_.topology.face(twin);
      if (size(f) == 3 && size(g) == 3 && geometry_.is_fold(f, HalfedgeId{h}, g, twin)) exchange(HalfedgeId{h}, f, twin, g);
    }
    std::sort(edits_.begin(), edits_.end());
    const std::uint64_t done = edits_.size() / 2;
    replace_faces(piece_, edits_);
    return mesh.face_count() == 0 ? 0 : done;
  }

 private:
  [[nodiscard]] std::uint32_t size(FaceId f) const { return view_.mesh.face_first[+f + 1] - view_.mesh.face_first[+f]; }
  [[nodiscard]] const Vec3& at(HalfedgeId slot) const { return view_.mesh.points[+view_.mesh.corners[+slot]]; }
  [[nodiscard]] bool has_edge(HalfedgeId a, HalfedgeId b) {
    const std::uint32_t u = +view_.mesh.corners[+a], v = +view_.mesh.corners[+b];
    if (!has_edges_) {
      has_edges_ = true;
      for (std::uint32_t h = 0; h < view_.mesh.corners.size(); ++h) {
        if (view_.topology.twin[h] == Topology::kSkipped) continue;
        const VertexId s = view_.mesh.corners[h];
        const VertexId t = view_.mesh.corners[+next(view_.mesh, view_.topology.face(HalfedgeId{h}), HalfedgeId{h})];
        edges_.push_back({std::min(+s, +t), std::max(+s, +t)});
      }
      std::sort(edges_.begin(), edges_.end());
    }
    const std::array<std::uint32_t, 2> key{std::min(u, v), std::max(u, v)};
    return std::binary_search(edges_.begin(), edges_.end(), key) || fresh_.count(key) != 0;
  }

  // h: u -> v in f; twin: v -> u in g.
  void exchange(HalfedgeId h, FaceId f, HalfedgeId twin, FaceId g) {
    if (used_.count(+f) != 0 || used_.count(+g) != 0) return;
    const HalfedgeId u = h, v = twin, a = previous(view_.mesh, f, h), b = previous(view_.mesh, g, twin);
    int axis = 0;
    while (axis < 2 && exact::orient2d(at(u), at(v), at(a), axis) == 0)
      ++axis;
    const int one = exact::orient2d(at(a), at(u), at(b), axis), other = exact::orient2d(at(b), at(v), at(a), axis);
    if (one * other < 0 || (one == 0 && other == 0)) return;  // neither lies in the other one
    const double height = std::min(height_of(at(u), at(v), at(a)), height_of(at(u), at(v), at(b)));
    if (!(height <= thickness_) || has_edge(a, b)) return;
    const auto point = [&](HalfedgeId slot) { return piece_.soup.corners[+slot]; };
    edits_.push_back({+f, {{point(a), point(u), point(b)}}});
    edits_.push_back({+g, {{point(b), point(v), point(a)}}});
    fresh_.insert({std::min(+view_.mesh.corners[+a], +view_.mesh.corners[+b]),
                   std::max(+view_.mesh.corners[+a], +view_.mesh.corners[+b])});
    used_.insert(+f);
    used_.insert(+g);
    tally_.done.push_back(piece_.source_face[+g]);
    tally_.thickest = std::max(tally_.thickest, height);
  }
  static double height_of(const Vec3& u, const Vec3& v, const Vec3& apex) {
    return length(cross(v - u, apex - u)) / length(v - u);
  }

  Workpiece& piece_;
  const View view_;
  FaceGeometry geometry_;
  double thickness_;
  UnfoldTally& tally_;
  FaceEdits edits_;
  std::set<std::uint32_t> used_;
  bool has_edges_ = false;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::set<std::array<std::uint32_t, 2>> fresh_;
};

// The distance of p from the segment.
double distance_from(const Vec3& p, const Vec3& a, const Vec3& b) {
  return distance_bound(p, {a, b, b});
}

// How far the points of a flap lie from the edges at which it hangs; infinite where it is none.
double depth_of_flap(const View& view, const EdgeTable& edges, const std::set<FaceId>& doubled, FaceId f) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::array<VertexId, 3> v{};
  std::copy_n(view.mesh.corners.begin() + view.mesh.face_first[+f], 3, v.begin());
  int hanging = 0;
  double depth = kNever;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto faces = edges.at(v[k], v[(k + 1) % 3]);
    if (faces.size() == 2) continue;  // those of the flap alone
    if (faces.size() != 4) return kNever;
    const bool hangs_at_others =
        std::count_if(faces.begin(), faces.end(), [&](const EdgeTable::Entry& e) { return doubled.count(e.face) == 0; }) == 2;
    if (!hangs_at_others) return kNever;
    ++hanging;
    const auto& p = view.mesh.points;
    depth = std::min(depth, distance_from(p[+v[(k + 2) % 3]], p[+v[k]], p[+v[(k + 1) % 3]]));
  }
  return hanging == 0 || hanging == 3 ? kNever : depth;
}

// Flaps: a triangle and its back, which hang at the surface by one edge or two and enclose nothing. Both go, so that the faces
// beside them meet.
std::uint64_t drop_flaps(Workpiece& piece, double thickness, UnfoldTally& tally) {
  const View view(piece);
  const std::vector<Duplicate> duplicates = duplicate_faces(view.mesh, view.topology, view.states);
  if (duplicates.empty()) return 0;
  const EdgeTable edges(view.mesh, view.states);
  std::set<FaceId> doubled;
  for (const Duplicate& duplicate : duplicates) {
    doubled.insert(duplicate.copy);
    doubled.insert(duplicate.first);
  }
  FaceEdits edits;
  for (const Duplicate& duplicate : duplicates) {
    if (view.mesh.face_first[+duplicate.copy + 1] - view.mesh.face_first[+duplicate.copy] != 3) continue;
    const double depth = depth_of_flap(view, edges, doubled, duplicate.copy);
    if (!(depth <= thickness)) continue;
    edits.push_back({+duplicate.first, {}});
    edits.push_back({+duplicate.copy, {}});
    tally.done.push_back(piece.source_face[+duplicate.copy]);
    tally.thickest = std::max(tally.thickest, depth);
    ++tally.flaps;
  }
  std::sort(edits.begin(), edits.end());
  edits.erase(std::unique(edits.begin(), edits.end()), edits.end());
  replace_faces(piece, edits);
  return edits.size() / 2;
}

}  // namespace

std::uint64_t unfold(Workpiece& piece, double thickness, UnfoldTally& tally) {
  constexpr int kMostRounds = 100;  // an unfolded sliver may fold onto the next
  std::uint64_t done = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::uint64_t fresh = Unfolder(piece, thickness, tally).run() + drop_flaps(piece, thickness, tally);
    if (fresh == 0) break;
    done += fresh;
  }
  if (done == 0) return 0;
  DegenerateTally flat;  // where the smaller one's corner lay on a side of the larger one
  drop_degenerate(piece, flat);
  return done;
}

RepairAction unfold_action(const Workpiece& piece, UnfoldTally& tally) {
  return action_of(
      piece, "unfold", Kind::faces,
      counted(tally.done.size() - tally.flaps, "folded sliver was", "folded slivers were") + " unfolded" +
          (tally.flaps == 0 ? ""
                            : "; " + counted(tally.flaps, "flap of two faces was", "flaps of two faces were") + " dropped"),
      tally);
}

}  // namespace fdcg::bake
