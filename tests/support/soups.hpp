// SPDX-License-Identifier: Apache-2.0
// Polygon soups made in code, for tests and benchmarks.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

using Faces = std::vector<std::vector<std::uint32_t>>;

inline bake::PolygonSoup make_soup(std::vector<bake::Vec3> points, const Faces& faces) {
  bake::PolygonSoup soup;
  soup.name = "made in code";
  soup.points = std::move(points);
  soup.face_first.push_back(0);
  for (const auto& face : faces) {
    soup.corners.insert(soup.corners.end(), face.begin(), face.end());
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  soup.relative_quantum = 0x1p-53;
  soup.sha256.assign(64, '0');
  return soup;
}

// The faces of `b` after those of `a`, on points of their own.
inline bake::PolygonSoup joined(bake::PolygonSoup a, const bake::PolygonSoup& b) {
  const auto points = static_cast<std::uint32_t>(a.points.size());
  const auto corners = static_cast<std::uint32_t>(a.corners.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const std::uint32_t corner : b.corners)
    a.corners.push_back(corner + points);
  for (std::size_t f = 1; f < b.face_first.size(); ++f)
    a.face_first.push_back(b.face_first[f] + corners);
  return a;
}

// Every face turned over.
inline bake::PolygonSoup reversed(bake::PolygonSoup soup) {
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const auto first = soup.corners.begin() + soup.face_first[f];
    const auto last = soup.corners.begin() + soup.face_first[f + 1];
    for (auto i = first, j = last; i < j && i < --j; ++i)
      std::swap(*i, *j);
  }
  return soup;
}

// An axis-parallel cube of six quads, outward; `size` is its edge.
inline bake::PolygonSoup cube(bake::Vec3 centre = {}, double size = 2) {
  std::vector<bake::Vec3> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back(
        {centre.x + size * ((i & 1) - 0.5), centre.y + size * ((i >> 1 & 1) - 0.5), centre.z + size * ((i >> 2 & 1) - 0.5)});
  }
  return make_soup(points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

// A closed sphere-like surface of 2 * rings * segments - 2 * segments triangles, outward, with a bumpy radius about 1.
inline bake::PolygonSoup bumpy_sphere(std::uint32_t rings, std::uint32_t segments, double bump = 0.1) {
  std::vector<bake::Vec3> points;
  points.push_back({0, 0, 1});
  constexpr double kPi = 3.14159265358979323846;
  for (std::uint32_t i = 1; i < rings; ++i) {
    const double theta = kPi * i / rings;
    for (std::uint32_t j = 0; j < segments; ++j) {
      const double phi = 2 * kPi * j / segments;
      const double r = 1 + bump * std::sin(7 * theta) * std::cos(5 * phi);
      points.push_back({r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi), r * std::cos(theta)});
    }
  }
  points.push_back({0, 0, -1});
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * segments + j % segments; };
  Faces faces;
  const auto south = static_cast<std::uint32_t>(points.size() - 1);
  for (std::uint32_t j = 0; j < segments; ++j)
    faces.push_back({0, at(1, j), at(1, j + 1)});
  for (std::uint32_t i = 1; i + 1 < rings; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  for (std::uint32_t j = 0; j < segments; ++j)
    faces.push_back({at(rings - 1, j), south, at(rings - 1, j + 1)});
  return make_soup(std::move(points), faces);
}

}  // namespace fdcg::test
