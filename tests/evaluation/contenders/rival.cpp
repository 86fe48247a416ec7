// SPDX-License-Identifier: Apache-2.0
#include "rival.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace fdcg::test {

RivalMesh::RivalMesh(const bake::PolygonSoup& soup) {
  points_m.reserve(3 * soup.points.size());
  for (const bake::Vec3& p : soup.points)
    points_m.insert(points_m.end(), {p.x, p.y, p.z});
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f];
    for (std::uint32_t k = first + 1; k + 1 < soup.face_first[f + 1]; ++k)
      corners.insert(corners.end(), {soup.corners[first], soup.corners[k], soup.corners[k + 1]});
  }
}

void check_rival(const std::string& specification, const ContenderInfo& info) {
  for (const std::string* word : {&info.name, &info.family, &info.precision}) {
    const bool is_word =
        !word->empty() && std::all_of(word->begin(), word->end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    if (!is_word)
      throw std::runtime_error(specification + ": name, family and precision are letters, digits and _, not '" + *word + "'");
  }
  if (info.family == "fdcg") throw std::runtime_error(specification + ": the family fdcg is this project's; name another");
}

void check_answer(const ContenderInfo& info, const Ground::Point& hip_m, const Feel& feel) {
  bool is_finite = true;
  for (std::size_t k = 0; k < 3; ++k)
    is_finite = is_finite && std::isfinite(feel.god_object[k]) && std::isfinite(feel.force[k]);
  if (is_finite) return;
  char text[120];
  std::snprintf(text, sizeof text, ": its answer to the HIP %a %a %a is not finite", hip_m[0], hip_m[1], hip_m[2]);
  throw std::runtime_error(info.name + text);
}

std::unique_ptr<Contender> make_rival(const std::string& specification, const bake::PolygonSoup& soup) {
  constexpr std::string_view kPipe = "pipe:";
  if (specification.starts_with(kPipe)) return make_rival_of_pipe(specification.substr(kPipe.size()), soup);
  return make_rival_of_library(specification, soup);
}

}  // namespace fdcg::test
