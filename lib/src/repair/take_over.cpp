// SPDX-License-Identifier: Apache-2.0
#include "repair/take_over.hpp"

#include <map>
#include <tuple>

#include "base/vec3.hpp"

namespace fdcg::bake {

void take_over(Workpiece& piece, const FacetSet& set) {
  const auto key = [](const Vec3& p) { return std::tuple(p.x, p.y, p.z); };
  std::map<std::tuple<double, double, double>, std::uint32_t> source_at;
  for (std::size_t v = 0; v < piece.soup.points.size(); ++v)
    source_at.emplace(key(piece.soup.points[v] + Vec3{}), piece.source_point[v]);
  const PolygonSoup& input = piece.input;
  PolygonSoup& soup = piece.soup;
  soup.points = set.points;
  soup.corners.clear();
  soup.face_first.assign(1, 0);
  piece.source_face.clear();
  piece.source_point.assign(set.points.size(), 0);
  for (const Facet& facet : set.facets) {
    for (const std::uint32_t corner : facet.corner) {
      soup.corners.push_back(corner);
      const auto same = source_at.find(key(set.points[corner]));
      piece.source_point[corner] = same != source_at.end() ? same->second : input.corners[input.face_first[facet.source]];
    }
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    piece.source_face.push_back(facet.source);
  }
}

}  // namespace fdcg::bake
