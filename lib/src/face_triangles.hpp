// SPDX-License-Identifier: Apache-2.0
// The triangles that faces are judged by where their surface matters and not only their corners.
#pragma once

#include <cstdint>
#include <vector>

#include "face_geometry.hpp"
#include "mesh.hpp"
#include "triangle_contact.hpp"

namespace fdcg::bake {

class FaceTriangles {
 public:
  // Cuts the polygons as triangulate() does; a fan from the first corner where that cannot be done, without its triangles that
  // lie on a line. A mesh of triangles costs nothing.
  FaceTriangles(const Mesh& mesh, const FaceGeometry& geometry, unsigned jobs);

  [[nodiscard]] std::uint32_t first(FaceId f) const { return first_.empty() ? +f : first_[+f]; }
  [[nodiscard]] std::uint32_t end(FaceId f) const { return first_.empty() ? +f + 1 : first_[+f + 1]; }
  [[nodiscard]] ContactTriangle operator[](std::uint32_t triangle) const {
    const VertexId* const c = first_.empty() ? &mesh_.corners[std::size_t{3} * triangle] : cut_[triangle].corner.data();
    const Vec3* const points = mesh_.points.data();
    return {{points + +c[0], points + +c[1], points + +c[2]}, first_.empty() ? std::uint8_t{0} : cut_[triangle].seams};
  }

 private:
  struct Cut {
    std::array<VertexId, 3> corner;
    std::uint8_t seams = 0;
  };
  class Cutter;

  const Mesh& mesh_;
  std::vector<std::uint32_t> first_;  // of each face, and where the last ends; empty where every face is a triangle
  std::vector<Cut> cut_;
};

}  // namespace fdcg::bake
