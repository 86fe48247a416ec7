// SPDX-License-Identifier: Apache-2.0
// Bodies with materials, for their tests.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "contact_rig.hpp"
#include "meshes.hpp"

namespace fdcg::test {

// A flat strip from x = -2 to 2 and y = -1 to 1, rubber up to x = 0 and ice beyond, in one plane.
inline constexpr const char* kStrip = R"(v -2 -1 0
v 0 -1 0
v 2 -1 0
v 2 1 0
v 0 1 0
v -2 1 0
usemtl rubber
f 1 2 5 6
usemtl unused
usemtl ice
f 2 3 4 5
)";

inline bake::PolygonSoup imported(const std::string& text, const std::string& name = "mesh.obj") {
  auto soup = bake::import_memory(text, name);
  if (!soup) throw std::runtime_error(soup.error().message);
  return *soup;
}

// Materials by what is asked of a face's middle and normal.
template <class Choose>
bake::PolygonSoup painted(bake::PolygonSoup soup, const std::vector<std::string>& names, Choose choose) {
  soup.materials = names;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], count = soup.face_first[f + 1] - first;
    Hip middle = {0, 0, 0};
    for (std::uint32_t c = first; c < first + count; ++c) {
      const Hip p = point_of(soup.points[soup.corners[c]]);
      for (std::size_t k = 0; k < 3; ++k)
        middle[k] += p[k] / count;
    }
    const Hip a = point_of(soup.points[soup.corners[first]]), b = point_of(soup.points[soup.corners[first + 1]]),
              c = point_of(soup.points[soup.corners[first + 2]]);
    const Hip u = difference(b, a), v = difference(c, a);
    soup.face_material.push_back(
        choose(f, middle, Hip{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]}));
  }
  return soup;
}

}  // namespace fdcg::test
