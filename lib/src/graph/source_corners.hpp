// SPDX-License-Identifier: Apache-2.0
// Which corner of the mesh file a corner of a triangle is.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.hpp"
#include "fdcg/bake.hpp"
#include "graph/triangulate.hpp"

namespace fdcg::bake {

class SourceCorners {
 public:
  // `source_face`: of each face of the mesh that was cut; empty: the same number. All must outlive the object.
  SourceCorners(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face, const Triangulation& cut)
      : soup_(soup), source_face_(source_face), cut_(cut) {}

  // The face of the soup that a triangle was cut from, or is nearest to where a repair made it; kNone: it is from none.
  [[nodiscard]] std::uint32_t face_of(std::uint32_t triangle) const {
    const std::uint32_t polygon = cut_.polygon.empty() ? triangle : cut_.polygon[triangle];
    const std::uint32_t face = source_face_.empty() ? polygon : source_face_[polygon];
    return face < soup_.face_count() ? face : kNone;
  }
  // The entry of the soup's corners that is nearest to a slot's place, of the face that its triangle is from; or kNone.
  [[nodiscard]] std::uint32_t at(std::uint32_t slot) const {
    const std::uint32_t face = face_of(slot / 3);
    if (face == kNone) return kNone;
    const Vec3 place = cut_.mesh.points[+cut_.mesh.corners[slot]] + cut_.mesh.origin;
    std::uint32_t nearest = kNone;
    double least = 0;
    for (std::uint32_t i = soup_.face_first[face]; i < soup_.face_first[face + 1]; ++i) {
      if (soup_.corners[i] == PolygonSoup::kInvalidVertex) continue;
      const double off = squared_length(soup_.points[soup_.corners[i]] - place);
      if (nearest == kNone || off < least) nearest = i, least = off;
    }
    return nearest;
  }

 private:
  const PolygonSoup& soup_;
  const std::vector<std::uint32_t>& source_face_;
  const Triangulation& cut_;
};

}  // namespace fdcg::bake
