// SPDX-License-Identifier: Apache-2.0
// Triangulation of the faces for checks of their surface and not only of their corners.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/mesh.hpp"
#include "exact/triangle_contact.hpp"
#include "topology/face_geometry.hpp"

namespace fdcg::bake {

class FaceTriangles {
 public:
  // Triangulates as triangulate() does; where that is impossible, by the fan from the first corner without its degenerate
  // triangles. Free for a mesh of triangles.
  FaceTriangles(const Mesh& mesh, const FaceGeometry& geometry, unsigned jobs);

  [[nodiscard]] std::uint32_t count() const { return is_plain_ ? mesh_.face_count() : static_cast<std::uint32_t>(cut_.size()); }
  [[nodiscard]] FaceId face(std::uint32_t triangle) const { return is_plain_ ? FaceId{triangle} : cut_[triangle].face; }
  // Whether every face is a triangle.
  [[nodiscard]] bool is_plain() const { return is_plain_; }
  [[nodiscard]] const VertexId* corners(std::uint32_t triangle) const {
    return is_plain_ ? &mesh_.corners[std::size_t{3} * triangle] : cut_[triangle].corner.data();
  }
  [[nodiscard]] ContactTriangle operator[](std::uint32_t triangle) const {
    const VertexId* const c = corners(triangle);
    const Vec3* const points = mesh_.points.data();
    return {{points + +c[0], points + +c[1], points + +c[2]}, is_plain_ ? std::uint8_t{0} : cut_[triangle].seams};
  }

 private:
  struct Cut {
    std::array<VertexId, 3> corner;
    FaceId face{kNone};
    std::uint8_t seams = 0;
  };
  class Cutter;

  const Mesh& mesh_;
  bool is_plain_;
  std::vector<Cut> cut_;  // ascending faces; not used where every face is a triangle
};

}  // namespace fdcg::bake
