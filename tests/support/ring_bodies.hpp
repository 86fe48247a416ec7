// SPDX-License-Identifier: Apache-2.0
// Cylinders, cones, discs, tubes and gears as modelling programs write them: any number of sides, caps as one polygon or as a
// fan around a centre, along each of the three axes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "meshes.hpp"

namespace fdcg::test {

enum class Cap { none, polygon, fan };

// Rings of `sides` points each around the axis z, closed surfaces by joining them in pairs.
class RingBody {
 public:
  explicit RingBody(std::uint32_t sides) : sides_(sides) {}

  // Returns the first of its points. Odd corners may stand nearer to the axis: a gear. As decimal files round them.
  std::uint32_t add_ring(double radius, double z, double odd_radius) {
    const auto first = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t i = 0; i < sides_; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides_, r = i % 2 == 0 ? radius : odd_radius;
      points_.push_back({six_digits(r * std::cos(angle)), six_digits(r * std::sin(angle)), z});
    }
    return first;
  }
  std::uint32_t add_ring(double radius, double z) { return add_ring(radius, z, radius); }
  std::uint32_t add_point(double z) {
    points_.push_back({0, 0, z});
    return static_cast<std::uint32_t>(points_.size() - 1);
  }

  // Outward where the second ring lies higher outside, further out below, lower inside, further in above.
  void join(std::uint32_t ring, std::uint32_t next_ring, bool has_triangles) {
    for (std::uint32_t i = 0; i < sides_; ++i) {
      const std::uint32_t j = (i + 1) % sides_;
      if (has_triangles) {
        faces_.push_back({ring + i, ring + j, next_ring + j});
        faces_.push_back({ring + i, next_ring + j, next_ring + i});
      } else {
        faces_.push_back({ring + i, ring + j, next_ring + j, next_ring + i});
      }
    }
  }
  void join_to_point(std::uint32_t ring, std::uint32_t point) {
    for (std::uint32_t i = 0; i < sides_; ++i)
      faces_.push_back({ring + i, ring + (i + 1) % sides_, point});
  }
  void join_from_point(std::uint32_t point, std::uint32_t ring) {
    for (std::uint32_t i = 0; i < sides_; ++i)
      faces_.push_back({point, ring + (i + 1) % sides_, ring + i});
  }
  void add_caps(Cap cap, std::uint32_t low, std::uint32_t high) {
    add_floor(cap, low);
    const double z = points_[high].z;
    if (cap == Cap::fan) join_to_point(high, add_point(z));
    if (cap == Cap::polygon) faces_.push_back(polygon_of(high));
  }
  void add_floor(Cap cap, std::uint32_t ring) {
    const double z = points_[ring].z;
    if (cap == Cap::fan) join_from_point(add_point(z), ring);
    if (cap != Cap::polygon) return;
    Polygon floor = polygon_of(ring);
    std::reverse(floor.begin(), floor.end());
    faces_.push_back(std::move(floor));
  }

  // With the axis z turned to another one: 0 is x, 1 is y, 2 is z.
  [[nodiscard]] PolygonSoup along(std::size_t axis) const {
    std::vector<Vec3> turned = points_;
    for (Vec3& p : turned)
      p = axis == 0 ? Vec3{p.z, p.x, p.y} : axis == 1 ? Vec3{p.y, p.z, p.x} : p;
    return make_soup("of " + std::to_string(sides_) + " sides along axis " + std::to_string(axis), turned, faces_);
  }

 private:
  static double six_digits(double x) { return std::round(x * 1e6) / 1e6; }
  [[nodiscard]] Polygon polygon_of(std::uint32_t ring) const {
    Polygon polygon;
    for (std::uint32_t i = 0; i < sides_; ++i)
      polygon.push_back(ring + i);
    return polygon;
  }

  std::uint32_t sides_;
  std::vector<Vec3> points_;
  std::vector<Polygon> faces_;
};

inline RingBody cylinder(std::uint32_t sides, Cap cap, double height, double odd_radius = 0.424264) {
  RingBody body(sides);
  const std::uint32_t low = body.add_ring(0.424264, -height / 2, odd_radius);
  const std::uint32_t high = body.add_ring(0.424264, height / 2, odd_radius);
  body.join(low, high, cap == Cap::fan);
  body.add_caps(cap, low, high);
  return body;
}

inline RingBody pointed(std::uint32_t sides, Cap cap) {
  RingBody body(sides);
  const std::uint32_t rim = body.add_ring(0.5, -0.5);
  body.join_to_point(rim, body.add_point(0.5));
  body.add_floor(cap, rim);
  return body;
}

// A pipe with a wall: its ends are flat rings around a hole.
inline RingBody pipe(std::uint32_t sides, bool has_triangles) {
  RingBody body(sides);
  const std::uint32_t outer_low = body.add_ring(0.5, -1), outer_high = body.add_ring(0.5, 1);
  const std::uint32_t inner_low = body.add_ring(0.3, -1), inner_high = body.add_ring(0.3, 1);
  body.join(outer_low, outer_high, has_triangles);
  body.join(outer_high, inner_high, has_triangles);
  body.join(inner_high, inner_low, has_triangles);
  body.join(inner_low, outer_low, has_triangles);
  return body;
}

}  // namespace fdcg::test
