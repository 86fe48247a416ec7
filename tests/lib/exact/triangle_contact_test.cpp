// SPDX-License-Identifier: Apache-2.0
#include "exact/triangle_contact.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/vec3.hpp"
#include "catch.hpp"
#include "exact/exact.hpp"
#include "exact/triangle_filter.hpp"
#include "random.hpp"

using namespace fdcg::bake;

namespace {

using Triple = std::array<std::uint32_t, 3>;

std::string name_of(Contact contact) {
  return contact == Contact::none ? "none" : contact == Contact::touching ? "touching" : "crossing";
}

// The contact of two triangles over common points; the same whatever corner each starts at, whichever way it runs, whichever of
// the two comes first and along whichever axis one looks.
std::string contact(const std::vector<Vec3>& points, Triple a, Triple b, unsigned a_seams = 0) {
  std::string answer;
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<Vec3> turned;
    for (const Vec3& p : points)
      turned.push_back(turn == 0 ? p : turn == 1 ? Vec3{p.y, p.z, p.x} : Vec3{p.z, p.x, p.y});
    for (unsigned order = 0; order < 36; ++order) {
      ContactTriangle s, t;
      const unsigned i = order % 3, j = order / 6 % 3;
      const bool flip_s = (order / 3 & 1u) != 0, flip_t = (order / 18 & 1u) != 0;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned from = flip_s ? (i + 3 - k) % 3 : (i + k) % 3;
        s.corner[k] = &turned[a[from]];
        const unsigned side = flip_s ? (from + 2) % 3 : from;  // flipped, the side after a corner is the one before it
        s.seams = static_cast<std::uint8_t>(s.seams | (a_seams >> side & 1u) << k);
        t.corner[k] = &turned[b[flip_t ? (j + 3 - k) % 3 : (j + k) % 3]];
      }
      const Contact there = contact_of(s, t), back = contact_of(t, s);
      if (there != back) return "differs when swapped";
      if (there != Contact::none && (are_surely_apart(s, t) || are_surely_apart(t, s))) return "filtered out";
      if (!answer.empty() && name_of(there) != answer) return "differs when turned";
      answer = name_of(there);
      if (there == Contact::none) continue;
      const Vec3 p = meeting_point(s, t);
      for (const ContactTriangle& triangle : {s, t}) {  // near the plane, and within the box
        const Vec3 n = cross(*triangle.corner[1] - *triangle.corner[0], *triangle.corner[2] - *triangle.corner[0]);
        if (std::abs(dot(n, p - *triangle.corner[0])) > 1e-12 * length(n)) return "met off the plane";
        for (int k = 0; k < 3; ++k) {
          const auto [low, high] = std::minmax(
              {component(*triangle.corner[0], k), component(*triangle.corner[1], k), component(*triangle.corner[2], k)});
          if (component(p, k) < low - 1e-12 || component(p, k) > high + 1e-12) return "met off the box";
        }
      }
    }
  }
  return answer;
}

// A triangle in the plane z = 0 around (1, 1, 0).
const std::vector<Vec3> kFloor{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

std::string contact_with_floor(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::vector<Vec3> points = kFloor;
  points.insert(points.end(), {a, b, c});
  return contact(points, {0, 1, 2}, {3, 4, 5});
}

}  // namespace

TEST_CASE("triangle contact without a common corner: every kind") {
  CHECK(contact_with_floor({1, 1, 1}, {2, 1, 1}, {1, 2, 2}) == "none");           // above
  CHECK(contact_with_floor({5, 5, -1}, {5, 6, 1}, {6, 5, 1}) == "none");          // through the plane, beside
  CHECK(contact_with_floor({3, 3, -1}, {3, 3, 1}, {4, 4, 0}) == "none");          // beside, boxes overlap
  CHECK(contact_with_floor({1, 1, -1}, {1, 1, 1}, {9, 9, 0}) == "crossing");      // across the rim
  CHECK(contact_with_floor({1, 1, -1}, {1, 2, 1}, {2, 1, 1}) == "crossing");      // a tip pokes through
  CHECK(contact_with_floor({-1, -1, -9}, {-1, -1, 9}, {9, 9, 0}) == "crossing");  // right through both rims
  CHECK(contact_with_floor({1, 1, 0}, {1, 2, 1}, {2, 1, 1}) == "touching");       // a vertex on the face
  CHECK(contact_with_floor({2, 2, 0}, {2, 3, 1}, {3, 2, 1}) == "touching");       // a vertex on the rim
  CHECK(contact_with_floor({4, 0, 0}, {5, 0, 1}, {5, 1, 1}) == "touching");       // a vertex on a vertex
  CHECK(contact_with_floor({1, 1, 0}, {2, 1, 0}, {1, 2, 1}) == "touching");       // an edge on the face
  CHECK(contact_with_floor({1, 1, 0}, {9, 9, 0}, {1, 2, 1}) == "touching");       // an edge out over the rim
  CHECK(contact_with_floor({1, 0, 0}, {3, 0, 0}, {2, -1, 1}) == "touching");      // an edge on the rim
  CHECK(contact_with_floor({2, -1, -1}, {2, 1, 1}, {2, -9, 9}) == "touching");    // two edges cross
  CHECK(contact_with_floor({1, 1, 0}, {1, 2, 1}, {2, 1, -1}) == "crossing");      // a vertex on the face, an edge through
  CHECK(contact_with_floor({2, 0, 0}, {2, -1, 1}, {2, -1, -1}) == "touching");    // a vertex on the rim, coming from outside
  CHECK(contact_with_floor({2, 0, 0}, {2, 1, 1}, {2, 1, -1}) == "crossing");      // and from inside
}

TEST_CASE("triangle contact in one plane without a common corner") {
  CHECK(contact_with_floor({1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}) == "crossing");  // inside
  CHECK(contact_with_floor({-9, -9, 0}, {20, 0, 0}, {0, 20, 0}) == "crossing");  // around
  CHECK(contact_with_floor({1, 1, 0}, {9, 1, 0}, {9, 2, 0}) == "crossing");      // across the rim
  CHECK(contact_with_floor({-1, 1, 0}, {6, 1, 0}, {6, 1.5, 0}) == "crossing");   // a bar across
  CHECK(contact_with_floor({2, 2, 0}, {9, 2, 0}, {9, 9, 0}) == "touching");      // a vertex on the rim
  CHECK(contact_with_floor({1, 0, 0}, {3, 0, 0}, {2, -1, 0}) == "touching");     // along the rim
  CHECK(contact_with_floor({-3, 0, 0}, {0, 0, 0}, {-3, -1, 0}) == "touching");   // vertex at vertex
  CHECK(contact_with_floor({3, 3, 0}, {9, 2, 0}, {9, 9, 0}) == "none");          // beside
  CHECK(contact_with_floor({0.1, 4.5, 0}, {4.5, 0.1, 0}, {9, 9, 0}) == "none");  // beside, boxes overlap
}

TEST_CASE("triangle contact with a shared corner: further common points") {
  const auto with = [](const Vec3& b, const Vec3& c) {
    std::vector<Vec3> points = kFloor;
    points.insert(points.end(), {b, c});
    return contact(points, {0, 1, 2}, {0, 3, 4});
  };
  CHECK(with({-1, 0, 0}, {0, -1, 0}) == "none");      // opposite in the plane
  CHECK(with({1, 0, 1}, {0, 1, 1}) == "none");        // off the plane
  CHECK(with({-1, 0, 1}, {0, -1, -1}) == "none");     // through the plane, on the other side
  CHECK(with({1, 1, -1}, {1, 1, 1}) == "crossing");   // pierces
  CHECK(with({9, 9, -1}, {9, 9, 1}) == "crossing");   // out across the opposite rim
  CHECK(with({1, 1, 0}, {1, 1, 1}) == "touching");    // an edge on the face
  CHECK(with({9, 9, 0}, {9, 9, 1}) == "touching");    // and beyond
  CHECK(with({2, 0, 0}, {2, 0, 1}) == "touching");    // an edge along an edge
  CHECK(with({2, 0, 0}, {2, -1, 0}) == "touching");   // the same in the plane
  CHECK(with({-2, 0, 0}, {-2, -1, 0}) == "none");     // in the plane, an edge straight on
  CHECK(with({2, 1, 0}, {1, 2, 0}) == "crossing");    // inside in the plane
  CHECK(with({2, 1, 0}, {2, -1, 0}) == "crossing");   // overlapping in the plane
  CHECK(with({9, -1, 0}, {-1, 9, 0}) == "crossing");  // around in the plane
}

TEST_CASE("triangle contact with a shared side, or all corners shared") {
  const auto with = [](const Vec3& c, unsigned seams = 0) {
    std::vector<Vec3> points = kFloor;
    points.push_back(c);
    return contact(points, {0, 1, 2}, {0, 1, 3}, seams);
  };
  CHECK(with({0, -4, 0}) == "none");
  CHECK(with({0, 4, 1}) == "none");
  CHECK(with({0, 4, 1e-300}) == "none");
  CHECK(with({1, 1, 0}) == "crossing");  // folded
  CHECK(with({0, 9, 0}) == "crossing");
  CHECK(with({4, 1e-9, 0}) == "crossing");
  // The side is a cut through a polygon: the other triangle has its rim there.
  CHECK(with({0, -4, 0}, 1) == "touching");
  CHECK(with({0, 4, 1}, 1) == "touching");
  CHECK(with({0, 4, 1}, 2) == "none");
  CHECK(contact(kFloor, {0, 1, 2}, {0, 1, 2}) == "crossing");
}

TEST_CASE("triangle contact: diagonals of a polygon count as interior") {
  // The first triangle's side from its corner 1 to 2 is a cut, and stands in the plane of the other.
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 2}, {2, 2, 0}, {2.5, 1.5, 0}};
  CHECK(contact(points, {3, 4, 5}, {0, 1, 2}) == "touching");
  CHECK(contact(points, {3, 4, 5}, {0, 1, 2}, 2) == "touching");  // two rims
  const std::vector<Vec3> inner{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 2}, {1, 1, 0}, {1.5, 1, 0}};
  CHECK(contact(inner, {3, 4, 5}, {0, 1, 2}) == "touching");
  CHECK(contact(inner, {3, 4, 5}, {0, 1, 2}, 2) == "crossing");
}

TEST_CASE("triangle contact: one unit in the last place is distinguished") {
  const double above = 0x1p-1074, beside = 4 * (1 - 0x1p-53);
  CHECK(contact_with_floor({1, 1, above}, {1, 2, 1}, {2, 1, 1}) == "none");
  CHECK(contact_with_floor({1, 1, -above}, {1, 2, 1}, {2, 1, 1}) == "crossing");
  CHECK(contact_with_floor({4, 0, 0}, {5, 0, 1}, {5, 0, -1}) == "touching");
  CHECK(contact_with_floor({beside, 0, 0}, {5, 0, 1}, {5, 0, -1}) == "touching");
  CHECK(contact_with_floor({4 * (1 + 0x1p-52), 0, 0}, {5, 0, 1}, {5, 0, -1}) == "none");
}

TEST_CASE("triangle filter: decides most neighbours and is never wrong") {
  constexpr std::uint64_t kSeed = 20261121;
  INFO("seed " << kSeed);
  fdcg::test::Random random(kSeed);
  std::size_t apart = 0, told = 0;
  for (int round = 0; round < 200'000; ++round) {
    // Coarse coordinates make many exact coincidences; every other round they are moved a little.
    std::vector<Vec3> points;
    for (int i = 0; i < 6; ++i) {
      const auto coordinate = [&] { return random.below(4) + (round % 2 == 0 ? 0 : random.uniform(-1e-3, 1e-3)); };
      points.push_back({coordinate(), coordinate(), coordinate()});
    }
    const std::uint32_t shared = random.below(3);
    ContactTriangle s{{&points[0], &points[1], &points[2]}, 0}, t{{&points[3], &points[4], &points[5]}, 0};
    for (std::uint32_t k = 0; k < shared; ++k)
      t.corner[(k + round) % 3] = s.corner[k];
    if (exact::collinear(*s.corner[0], *s.corner[1], *s.corner[2])) continue;
    if (exact::collinear(*t.corner[0], *t.corner[1], *t.corner[2])) continue;
    const Contact contact = contact_of(s, t);
    REQUIRE(contact_of(t, s) == contact);
    const bool is_told = are_surely_apart(s, t);
    if (is_told) REQUIRE(contact == Contact::none);
    apart += contact == Contact::none;
    told += is_told;
  }
  CHECK(apart > 20'000);
  CHECK(told > apart / 2);
}
