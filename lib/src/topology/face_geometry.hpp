// SPDX-License-Identifier: Apache-2.0
// Exact properties of each face: whether it is degenerate, the signs of its normal, whether it is planar or folded onto a
// neighbour.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// Computed per face on demand; expensive results are cached. Belongs to one Mesh, whose loops must not change.
class FaceGeometry {
 public:
  // One linear pass: a floating-point filter with a proven error bound, exact predicates where it is undecided.
  FaceGeometry(const Mesh& mesh, const std::vector<FaceState>& states, unsigned jobs = 1);

  // Every face has three corners, and face f the slots 3 f to 3 f + 2.
  [[nodiscard]] bool has_triangles_only() const { return frames_.empty(); }
  // All corners are finite. False for faces with an invalid corner.
  [[nodiscard]] bool is_finite(FaceId f) const { return (bits_[+f] & kNotFinite) == 0; }
  // A repeated corner, fewer than three corners, or exactly collinear corners. Collinearity is not tested for a face that is
  // not finite.
  [[nodiscard]] bool is_degenerate(FaceId f) const { return (bits_[+f] & kDegenerate) != 0; }
  // Whether all corners are exactly coplanar. Cached: linear in the corners the first time.
  [[nodiscard]] bool is_flat(FaceId f);
  // The faces of half-edges `h` and `other`, which run along one edge, lie exactly in one plane and on the same side of that
  // edge: a dihedral angle of 0 or 360 degrees. False where one of them is degenerate, not finite or not flat.
  [[nodiscard]] bool is_fold(FaceId a, HalfedgeId h, FaceId b, HalfedgeId other);

 private:
  // Bits 0..2: the normal's x, y, z is certainly positive; bits 3..5: certainly negative.
  static constexpr std::uint8_t kNotFinite = 64, kDegenerate = 128, kSigns = 63;

  [[nodiscard]] const Vec3& point(std::uint32_t slot) const { return mesh_.points[+mesh_.corners[slot]]; }
  [[nodiscard]] std::uint32_t first(FaceId f) const { return mesh_.face_first[+f]; }
  [[nodiscard]] std::uint32_t size(FaceId f) const { return mesh_.face_first[+f + 1] - mesh_.face_first[+f]; }
  void look_at(FaceId f, FaceState state);
  [[nodiscard]] std::uint8_t certain_signs(FaceId f) const;
  // The slots of the first corner, the first after it elsewhere, and the first after that off their line; false if there are
  // none.
  bool find_frame(FaceId f, std::array<std::uint32_t, 3>& frame) const;
  [[nodiscard]] std::array<std::uint32_t, 3> frame(FaceId f) const;
  [[nodiscard]] int sign_along(FaceId f, int axis) const;

  const Mesh& mesh_;
  std::vector<std::uint8_t> bits_;
  std::vector<std::array<std::uint32_t, 3>> frames_;  // of each face; empty where every face is a triangle
  enum class Flat : std::uint8_t { unknown, no, yes };
  std::vector<Flat> flat_;  // likewise
};

}  // namespace fdcg::bake
