// SPDX-License-Identifier: Apache-2.0
// Closes holes, for a surface that encloses something. What is closed need not be free of intersections: repair_solid.cpp
// resolves them.
#include <algorithm>
#include <unordered_set>

#include "base/vec3.hpp"
#include "repair/boundary_loops.hpp"
#include "repair/hole_patch.hpp"
#include "repair/repair.hpp"

namespace fdcg::bake {
namespace {

class HoleCloser {
 public:
  HoleCloser(Workpiece& piece, HoleTally& tally) : piece_(piece), tally_(tally), view_(piece) {
    for (std::uint32_t f = 0; f < view_.mesh.face_count(); ++f) {
      for (std::uint32_t h = view_.mesh.face_first[f]; h < view_.mesh.face_first[f + 1]; ++h)
        edges_.insert(key(+view_.mesh.corners[h], +view_.mesh.corners[+next(view_.mesh, FaceId{f}, HalfedgeId{h})]));
    }
  }

  void run(double largest) {
    std::vector<std::pair<std::uint32_t, Loops>> patches;
    for (const BoundaryLoop& loop : boundary_loops(view_.mesh, view_.topology)) {
      const std::uint32_t source = piece_.source_face[+loop.faces[0]];
      if (loop.is_slit) continue;  // encloses nothing
      if (loop.size > largest) {
        tally_.leave(source, "at a hole larger than the limit");
        tally_.largest_left = std::max(tally_.largest_left, loop.size);
        continue;
      }
      patches.emplace_back(+loop.faces[0], patch(loop));
      tally_.done.push_back(source);
      tally_.largest = std::max(tally_.largest, loop.size);
    }
    insert(std::move(patches));
  }

 private:
  using Loops = std::vector<std::vector<std::uint32_t>>;

  static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

  // The triangles, as points of the soup.
  Loops patch(const BoundaryLoop& loop) {
    std::vector<Vec3> outline;
    for (const VertexId v : loop.corners)
      outline.push_back(piece_.soup.points[view_.mesh.source_point[+v]]);
    const HolePatch closed = patch_hole(outline, normals_at(loop), [&](std::uint32_t i, std::uint32_t j) {
      return edges_.contains(key(+loop.corners[i], +loop.corners[j]));
    });
    ++(closed.is_flat ? tally_.flat : tally_.fair);
    std::vector<std::uint32_t> number;
    for (const VertexId v : loop.corners)
      number.push_back(view_.mesh.source_point[+v]);
    for (const Vec3& p : closed.points) {
      number.push_back(static_cast<std::uint32_t>(piece_.soup.points.size()));
      piece_.soup.points.push_back(p);
      piece_.source_point.push_back(piece_.source_point[number[0]]);
    }
    Loops triangles;
    for (const auto& [a, b, c] : closed.triangles) {
      triangles.push_back({number[a], number[b], number[c]});
      if (std::max({a, b, c}) >= loop.corners.size()) continue;
      edges_.insert(key(+loop.corners[a], +loop.corners[b]));
      edges_.insert(key(+loop.corners[b], +loop.corners[c]));
      edges_.insert(key(+loop.corners[c], +loop.corners[a]));
    }
    return triangles;
  }

  [[nodiscard]] std::vector<Vec3> normals_at(const BoundaryLoop& loop) const {
    std::vector<Vec3> normals;
    for (const FaceId f : loop.faces) {
      Vec3 normal;
      const auto at = [&](std::uint32_t c) { return view_.mesh.points[+view_.mesh.corners[c]]; };
      const std::uint32_t first = view_.mesh.face_first[+f];
      for (std::uint32_t c = first + 1; c + 1 < view_.mesh.face_first[+f + 1]; ++c)
        normal = normal + cross(at(c) - at(first), at(c + 1) - at(first));
      normals.push_back(normal);
    }
    return normals;
  }

  // Behind the face at each hole, whose source they get.
  void insert(std::vector<std::pair<std::uint32_t, Loops>> patches) {
    std::stable_sort(patches.begin(), patches.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    FaceEdits edits;
    for (auto& [face, triangles] : patches) {
      if (edits.empty() || edits.back().first != face) {
        const auto corners = piece_.soup.corners.begin();
        edits.push_back({face, {{corners + piece_.soup.face_first[face], corners + piece_.soup.face_first[face + 1]}}});
      }
      Loops& loops = edits.back().second;
      loops.insert(loops.end(), triangles.begin(), triangles.end());
    }
    replace_faces(piece_, edits);
  }

  Workpiece& piece_;
  HoleTally& tally_;
  View view_;
  std::unordered_set<std::uint64_t> edges_;
};

}  // namespace

void close_holes(Workpiece& piece, double largest, HoleTally& tally) {
  HoleCloser(piece, tally).run(largest);
}

RepairAction close_holes_action(const Workpiece& piece, HoleTally& tally) {
  std::string message = counted(tally.done.size(), "hole was closed", "holes were closed");
  if (!tally.done.empty()) {
    message += ": " + counted(tally.flat, "flat", "flat") + ", " + counted(tally.fair, "not flat", "not flat") +
               "; the largest is " + in_digits(tally.largest) + " across; each is listed by a face at it";
  }
  RepairAction action = action_of(piece, "close-holes", Kind::faces, std::move(message), tally);
  if (action.left != 0) {
    action.left_message = counted(action.left, "hole was left", "holes were left") +
                          " open: larger than --hole-size; the largest is " + in_digits(tally.largest_left) +
                          " across; each is listed by a face at it";
  }
  return action;
}

}  // namespace fdcg::bake
