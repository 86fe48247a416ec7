// SPDX-License-Identifier: Apache-2.0
// The data passed between the stages weld -> topology -> validate -> orient -> regions -> graph: an indexed polygon mesh in the
// local frame, whose coordinates are exactly those that the file will store.
#pragma once

#include <cstdint>
#include <vector>

#include "base/ids.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

struct Mesh {
  std::vector<Vec3> points;                 // local: (source - origin), rounded to the storage precision
  Vec3 origin;                              // source units
  std::vector<std::uint32_t> face_first;    // face f: corner slots face_first[f] .. face_first[f + 1] - 1
  std::vector<VertexId> corners;            // welded vertices, or VertexId{kNone} where the soup's index was invalid
  std::vector<std::uint32_t> source_point;  // of each vertex: the first source vertex welded into it
  std::vector<std::uint32_t> source_face;   // of each face; empty: the same number
  std::uint64_t joined_vertices = 0;        // source vertices that the weld joined to another

  [[nodiscard]] std::uint32_t face_count() const {
    return face_first.empty() ? 0 : static_cast<std::uint32_t>(face_first.size() - 1);
  }
  [[nodiscard]] std::uint32_t source_of(FaceId f) const { return source_face.empty() ? +f : source_face[+f]; }
};

// Adjacency of the faces of one Mesh.
struct Topology {
  static constexpr HalfedgeId kBoundary{0xFFFFFFFFu};     // the edge belongs to one face
  static constexpr HalfedgeId kNonManifold{0xFFFFFFFEu};  // the edge belongs to more than two faces
  static constexpr HalfedgeId kSameWay{0xFFFFFFFDu};      // two faces traverse the edge in the same direction
  static constexpr HalfedgeId kSkipped{0xFFFFFFFCu};      // the face is degenerate or invalid and is ignored

  std::vector<HalfedgeId> twin;  // of each corner slot: the opposite half-edge, or one of the above
  std::vector<FaceId> face_of;   // of each corner slot; empty where every face is a triangle (then slot / 3)

  [[nodiscard]] FaceId face(HalfedgeId h) const { return face_of.empty() ? FaceId{+h / 3} : face_of[+h]; }
};

[[nodiscard]] inline bool is_halfedge(HalfedgeId h) {
  return +h < +Topology::kSkipped;
}

[[nodiscard]] inline HalfedgeId next(const Mesh& mesh, FaceId f, HalfedgeId h) {
  return HalfedgeId{+h + 1 < mesh.face_first[+f + 1] ? +h + 1 : mesh.face_first[+f]};
}
[[nodiscard]] inline HalfedgeId previous(const Mesh& mesh, FaceId f, HalfedgeId h) {
  return HalfedgeId{+h > mesh.face_first[+f] ? +h - 1 : mesh.face_first[+f + 1] - 1};
}

}  // namespace fdcg::bake
