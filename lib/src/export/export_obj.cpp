// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: v and f, an object for each part, usemtl.
#include "export/export.hpp"

namespace fdcg::bake {

void write_obj(const PolygonSoup& soup, std::string& out) {
  constexpr std::size_t kLikelyVertex = 62, kLikelyCorner = 9;  // bytes
  out.reserve(soup.points.size() * kLikelyVertex + soup.corners.size() * kLikelyCorner);
  for (const Vec3& point : soup.points) {
    out += "v ";
    put_point(out, point);
    out += '\n';
  }
  auto part = soup.parts.begin();
  std::uint16_t material = PolygonSoup::kNoMaterial;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    for (; part != soup.parts.end() && part->first_face <= f; ++part) {
      out += "o ";
      put_name(out, part->name);
      out += '\n';
    }
    const std::uint16_t now = soup.face_material.empty() ? PolygonSoup::kNoMaterial : soup.face_material[f];
    if (now != material && now != PolygonSoup::kNoMaterial) {
      out += "usemtl ";
      put_name(out, soup.materials[now]);
      out += '\n';
    } else if (now != material) {
      out += "usemtl\n";
    }
    material = now;
    out += 'f';
    for (std::uint32_t c = soup.face_first[f]; c < soup.face_first[f + 1]; ++c) {
      out += ' ';
      // Indices count from 1: 0 is invalid.
      put_number(out, soup.corners[c] == PolygonSoup::kInvalidVertex ? 0u : soup.corners[c] + 1);
    }
    out += '\n';
  }
}

}  // namespace fdcg::bake
