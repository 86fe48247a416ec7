// SPDX-License-Identifier: Apache-2.0
// Cylinders, cones, discs, tubes and gears as modelling programs write them: every number of sides from 3 to 200, caps as one
// polygon or as a fan around a centre, along each of the three axes. Flat caps merge, and are cut again where a node would get
// too many sides.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "compiled.hpp"
#include "meshes.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

constexpr std::uint32_t kFewestSides = 3, kMostSides = 200;
constexpr std::uint32_t kMostSidesOfANode = 16;

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

RingBody cylinder(std::uint32_t sides, Cap cap, double height, double odd_radius = 0.424264) {
  RingBody body(sides);
  const std::uint32_t low = body.add_ring(0.424264, -height / 2, odd_radius);
  const std::uint32_t high = body.add_ring(0.424264, height / 2, odd_radius);
  body.join(low, high, cap == Cap::fan);
  body.add_caps(cap, low, high);
  return body;
}

RingBody pointed(std::uint32_t sides, Cap cap) {
  RingBody body(sides);
  const std::uint32_t rim = body.add_ring(0.5, -0.5);
  body.join_to_point(rim, body.add_point(0.5));
  body.add_floor(cap, rim);
  return body;
}

// A pipe with a wall: its ends are flat rings around a hole.
RingBody pipe(std::uint32_t sides, bool has_triangles) {
  RingBody body(sides);
  const std::uint32_t outer_low = body.add_ring(0.5, -1), outer_high = body.add_ring(0.5, 1);
  const std::uint32_t inner_low = body.add_ring(0.3, -1), inner_high = body.add_ring(0.3, 1);
  body.join(outer_low, outer_high, has_triangles);
  body.join(outer_high, inner_high, has_triangles);
  body.join(inner_high, inner_low, has_triangles);
  body.join(inner_low, outer_low, has_triangles);
  return body;
}

using Family = std::function<RingBody(std::uint32_t sides)>;

// Compiles to a sound file of the same shape, whose flat faces are merged into nodes of a bounded number of sides.
void check_family(const Family& family, int euler_characteristic) {
  for (std::uint32_t sides = kFewestSides; sides <= kMostSides; ++sides) {
    const RingBody body = family(sides);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const WalkedGraph graph = compile_sound(body.along(axis));
      CAPTURE(sides, axis);
      CHECK(graph.euler_characteristic() == euler_characteristic);
      const auto is_too_large = [](const WalkedNode& node) { return node.side_count > kMostSidesOfANode; };
      CHECK(std::none_of(graph.nodes.begin(), graph.nodes.end(), is_too_large));
    }
  }
}

}  // namespace

TEST_CASE("cylinders of 3 to 200 sides compile, their caps fans around a centre") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::fan, 1.6); }, 2);
}

TEST_CASE("prisms of 3 to 200 sides compile, their caps polygons") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::polygon, 1.6); }, 2);
}

TEST_CASE("closed discs of 3 to 200 sides compile, with and without centres") {
  check_family([](std::uint32_t sides) { return cylinder(sides, sides % 2 == 0 ? Cap::fan : Cap::polygon, 1e-3); }, 2);
  check_family([](std::uint32_t sides) { return cylinder(sides, sides % 2 == 0 ? Cap::polygon : Cap::fan, 1e-3); }, 2);
}

TEST_CASE("gears of 3 to 200 corners compile, with centres") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::fan, 0.2, 0.35); }, 2);
}

TEST_CASE("cones of 3 to 200 sides compile, with and without a centre of the base") {
  check_family([](std::uint32_t sides) { return pointed(sides, Cap::fan); }, 2);
  check_family([](std::uint32_t sides) { return pointed(sides, Cap::polygon); }, 2);
}

TEST_CASE("tubes of 3 to 200 sides compile, open ones and ones with a wall") {
  check_family([](std::uint32_t sides) { return cylinder(sides, Cap::none, 1.6); }, 0);
  check_family([](std::uint32_t sides) { return pipe(sides, sides % 2 == 0); }, 0);
}
