// SPDX-License-Identifier: Apache-2.0
// Cylinders, prisms, cones, discs, tubes and gears of 3 to 200 sides through repair: whole ones stay as they are, and damaged
// ones become whole again, face for face, and compile.
#include <algorithm>
#include <array>
#include <functional>
#include <set>

#include "compiled.hpp"
#include "ring_bodies.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

constexpr std::uint32_t kFewest = 3, kMost = 200;
constexpr double kAllowance = 0x1p-24;  // of measuring, step by step, where a cap that was turned is cut into other triangles

using Corner = std::array<double, 3>;
using Loop = std::vector<Corner>;

// The faces by their coordinates, each from its least corner on.
std::multiset<Loop> loops_of(const PolygonSoup& soup) {
  std::multiset<Loop> loops;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    Loop loop;
    for (std::uint32_t h = soup.face_first[f]; h < soup.face_first[f + 1]; ++h) {
      const Vec3& p = soup.points[soup.corners[h]];
      loop.push_back({p.x, p.y, p.z});
    }
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    loops.insert(std::move(loop));
  }
  return loops;
}

// Every face with points of its own, as in STL; a third of them turned, a quarter there twice, and a face without area beside
// every fifth.
PolygonSoup damaged(const PolygonSoup& clean) {
  std::vector<Vec3> points;
  std::vector<Polygon> faces;
  const auto add = [&](Polygon face, bool is_turned) {
    if (is_turned) std::reverse(face.begin(), face.end());
    Polygon own;
    for (const std::uint32_t corner : face) {
      own.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(clean.points[corner]);
    }
    faces.push_back(std::move(own));
  };
  for (std::size_t f = 0; f < clean.face_count(); ++f) {
    const Polygon face = face_corners(clean, f);
    add(face, f % 3 == 1);
    if (f % 4 == 2) add(face, f % 8 == 2);
    if (f % 5 == 3) add({face[0], face[1], face[0]}, false);
  }
  return make_soup(clean.name + ", damaged", points, faces);
}

std::string left_of(const Report& report) {
  std::string left;
  for (const Issue& issue : report.issues) {
    if (issue.severity == Severity::error) left += " " + issue.rule + " " + std::to_string(issue.total);
  }
  return left;
}

void check_repairs(const std::function<RingBody(std::uint32_t sides)>& family, int euler_characteristic) {
  for (std::uint32_t sides = kFewest; sides <= kMost; ++sides) {
    const PolygonSoup clean = family(sides).along(sides % 3);
    CAPTURE(sides);
    const Result<Repaired> same = repair(clean, repair_options(RepairLevel::full));
    REQUIRE(same.has_value());
    for (const RepairAction& action : same->actions) {
      INFO(action.name);
      CHECK(action.total == 0);
    }
    CHECK(same->distance == 0);
    CHECK(loops_of(same->soup) == loops_of(clean));

    const Result<Repaired> mended = repair(damaged(clean), repair_options(RepairLevel::full));
    REQUIRE(mended.has_value());
    CHECK(left_of(mended->after) == "");
    CHECK(loops_of(mended->soup) == loops_of(clean));
    CHECK(mended->distance <= kAllowance);
    const WalkedGraph graph = compile_sound(mended->soup);
    CHECK(graph.euler_characteristic() == euler_characteristic);
  }
}

}  // namespace

TEST_CASE("repair of cylinders and prisms of 3 to 200 sides") {
  check_repairs([](std::uint32_t sides) { return cylinder(sides, sides % 2 == 0 ? Cap::fan : Cap::polygon, 1.6); }, 2);
  check_repairs([](std::uint32_t sides) { return cylinder(sides, sides % 2 == 0 ? Cap::polygon : Cap::fan, 1e-3); }, 2);
}

TEST_CASE("repair of gears of 3 to 200 corners") {
  check_repairs([](std::uint32_t sides) { return cylinder(sides, Cap::fan, 0.2, 0.35); }, 2);
}

TEST_CASE("repair of cones of 3 to 200 sides") {
  check_repairs([](std::uint32_t sides) { return pointed(sides, sides % 2 == 0 ? Cap::fan : Cap::polygon); }, 2);
}

TEST_CASE("repair of tubes of 3 to 200 sides") {
  check_repairs([](std::uint32_t sides) { return cylinder(sides, Cap::none, 1.6); }, 0);
  check_repairs([](std::uint32_t sides) { return pipe(sides, sides % 2 == 0); }, 0);
}
