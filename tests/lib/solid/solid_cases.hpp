// SPDX-License-Identifier: Apache-2.0
// Meshes that pass through themselves, lie in one another, or are open, of which it is known what they enclose.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

// Puts triangles together.
class SoupMaker {
 public:
  using Vec3 = bake::Vec3;
  SoupMaker() { soup_.face_first = {0}; }

  std::uint32_t point(const Vec3& p) {
    soup_.points.push_back(p);
    return static_cast<std::uint32_t>(soup_.points.size() - 1);
  }
  void face(const std::vector<std::uint32_t>& corners) {
    soup_.corners.insert(soup_.corners.end(), corners.begin(), corners.end());
    soup_.face_first.push_back(static_cast<std::uint32_t>(soup_.corners.size()));
  }
  // Sides: bit 0 the face of least x, bit 1 of most x, then y and z.
  void box(const Vec3& low, const Vec3& high, unsigned sides = 63, bool is_turned = false) {
    std::array<std::uint32_t, 8> v{};
    for (unsigned i = 0; i < 8; ++i)
      v[i] = point({(i & 1u) != 0 ? high.x : low.x, (i & 2u) != 0 ? high.y : low.y, (i & 4u) != 0 ? high.z : low.z});
    constexpr unsigned kQuads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (unsigned side = 0; side < 6; ++side) {
      if ((sides >> side & 1u) == 0) continue;
      const auto& q = kQuads[side];
      is_turned ? face({v[q[0]], v[q[2]], v[q[1]]}) : face({v[q[0]], v[q[1]], v[q[2]]});
      is_turned ? face({v[q[0]], v[q[3]], v[q[2]]}) : face({v[q[0]], v[q[2]], v[q[3]]});
    }
  }
  // Rings of points; `at(u, v)`, both in 0 .. 1. Where it comes back to the same point in u, so do the faces.
  void sheet(unsigned columns, unsigned rows, const std::function<Vec3(double, double)>& at, bool is_closed_in_u,
             bool is_closed_in_v, const std::function<bool(unsigned, unsigned)>& has = {}) {
    std::vector<std::uint32_t> v;
    const unsigned across = is_closed_in_u ? columns : columns + 1, up = is_closed_in_v ? rows : rows + 1;
    for (unsigned j = 0; j < up; ++j) {
      for (unsigned i = 0; i < across; ++i)
        v.push_back(point(at(static_cast<double>(i) / columns, static_cast<double>(j) / rows)));
    }
    for (unsigned j = 0; j < rows; ++j) {
      for (unsigned i = 0; i < columns; ++i) {
        if (has && !has(i, j)) continue;
        const std::uint32_t a = v[j * across + i], b = v[j * across + (i + 1) % across],
                            c = v[(j + 1) % up * across + (i + 1) % across], d = v[(j + 1) % up * across + i];
        face({a, b, c});
        face({a, c, d});
      }
    }
  }
  void sphere(const Vec3& middle, double radius, unsigned rings, const std::function<bool(unsigned, unsigned)>& has = {}) {
    constexpr double kPi = 3.14159265358979323846;
    sheet(
        2 * rings, rings,
        [&](double u, double w) {
          const double turn = 2 * kPi * u, fall = kPi * (w - 0.5), flat = w == 0 || w == 1 ? 0 : std::cos(fall);
          return Vec3{middle.x + radius * flat * std::cos(turn), middle.y + radius * flat * std::sin(turn),
                      middle.z + radius * std::sin(fall)};
        },
        true, false, has);
  }
  [[nodiscard]] bake::PolygonSoup take(const std::string& name) {
    soup_.name = name;
    return std::move(soup_);
  }

 private:
  bake::PolygonSoup soup_;
};

struct SolidCase {
  bake::PolygonSoup soup;
  double volume;         // enclosed; 0: nothing is
  double tolerance = 0;  // of the volume, relative
  std::uint64_t components = 1;
};

std::vector<SolidCase> solid_cases();

}  // namespace fdcg::test
