// SPDX-License-Identifier: Apache-2.0
#include "graph/face_materials.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <utility>

#include "fdcg/fdcg.h"
#include "shared/text.hpp"

namespace fdcg::bake {

void split_by_material(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face, const Triangulation& cut,
                       Regions& regions) {
  if (soup.materials.empty() || regions.list.empty()) return;
  const std::size_t wholes = regions.list.size();
  std::vector<bool> is_met(wholes, false);
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> piece;  // of a region beyond its first material
  for (std::uint32_t t = 0; t < regions.of_face.size(); ++t) {
    const std::uint32_t r = regions.of_face[t];
    if (r == kNone) continue;
    const std::uint32_t polygon = cut.polygon.empty() ? t : cut.polygon[t];
    const std::uint16_t material = soup.face_material[source_face.empty() ? polygon : source_face[polygon]];
    if (!is_met[r]) regions.list[r].material = material;
    is_met[r] = true;
    if (regions.list[r].material == material) continue;
    const auto [found, is_new] = piece.emplace(std::pair(r, material), static_cast<std::uint32_t>(regions.list.size()));
    if (is_new) {
      regions.list[r].whole = r;
      regions.list.push_back(regions.list[r]);
      regions.list.back().material = material;
    }
    regions.of_face[t] = found->second;
  }
}

std::vector<std::uint16_t> material_of_faces(const PolygonSoup& soup, const Merged& faces,
                                             const std::vector<std::uint32_t>& face_of_source) {
  if (soup.materials.empty()) return {};
  std::vector<std::uint16_t> material(faces.mesh.face_count(), PolygonSoup::kNoMaterial);
  for (std::uint32_t source = 0; source < soup.face_count(); ++source) {
    const std::uint32_t face = face_of_source.empty() ? source : face_of_source[source];
    if (face != kNone) material[face] = soup.face_material[source];
  }
  // A merged face may contain the centre of no source face.
  for (std::uint32_t face = 0; face < faces.mesh.face_count(); ++face) {
    const std::uint32_t region = faces.regions.of(FaceId{face});
    if (region != kNone) material[face] = faces.regions.list[region].material;
  }
  return material;
}

fdcg_material_record material_record(const std::string& name) {
  constexpr std::size_t kLongest = FDCG_MATERIAL_NAME_BYTES - 1, kKept = 54;
  std::string text = valid_utf8(name);
  if (text != name || text.size() > kLongest) {
    std::array<char, 16> sum{};
    std::snprintf(sum.data(), sum.size(), "~%08x", static_cast<unsigned>(fdcg_checksum(name.data(), name.size()) >> 32));
    std::size_t keep = std::min(kKept, text.size());
    while (keep > 0 && keep < text.size() && (static_cast<unsigned char>(text[keep]) & 0xC0) == 0x80)
      --keep;  // in the middle of a character
    text = text.substr(0, keep) + sum.data();
  }
  fdcg_material_record record{};
  std::copy(text.begin(), text.end(), record.name);
  return record;
}

}  // namespace fdcg::bake
