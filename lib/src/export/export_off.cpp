// SPDX-License-Identifier: Apache-2.0
// Object File Format of Geomview: the keyword, the counts, a line for each vertex and each face.
#include "export/export.hpp"

namespace fdcg::bake {

void write_off(const PolygonSoup& soup, std::string& out) {
  constexpr std::size_t kLikelyVertex = 60, kLikelyCorner = 9;  // bytes
  out.reserve(soup.points.size() * kLikelyVertex + soup.corners.size() * kLikelyCorner);
  out += "OFF\n";
  put_number(out, soup.points.size());
  out += ' ';
  put_number(out, soup.face_count());
  out += " 0\n";  // number of edges: ignored by readers
  for (const Vec3& point : soup.points) {
    put_point(out, point);
    out += '\n';
  }
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    put_number(out, soup.face_first[f + 1] - soup.face_first[f]);
    for (std::uint32_t c = soup.face_first[f]; c < soup.face_first[f + 1]; ++c) {
      out += ' ';
      if (soup.corners[c] == PolygonSoup::kInvalidVertex) {
        out += "-1";
      } else {
        put_number(out, soup.corners[c]);
      }
    }
    out += '\n';
  }
}

}  // namespace fdcg::bake
