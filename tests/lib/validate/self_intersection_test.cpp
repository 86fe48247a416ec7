// SPDX-License-Identifier: Apache-2.0
#include "validate/self_intersection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "random.hpp"
#include "soups.hpp"
#include "topology/topology.hpp"
#include "topology/weld.hpp"
#include "validate/simple_stars.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::Faces;
using fdcg::test::joined;
using fdcg::test::make_soup;
using fdcg::test::Random;

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Contacts = std::map<Pair, Contact>;

struct Subject {
  Mesh mesh;
  FaceGeometry geometry;
  Topology topology;
  explicit Subject(const PolygonSoup& soup)
      : mesh(weld_points(soup, {}, Precision::f64, 1)), geometry(mesh, face_states(mesh)), topology(pair_halfedges(mesh)) {}
  [[nodiscard]] SelfIntersections found(std::size_t most = kAllElements, unsigned jobs = 2) const {
    const SelfIntersections plain = find_self_intersections(mesh, geometry, {most, jobs, {}});
    SelfIntersections found = find_self_intersections(mesh, geometry, {most, jobs, {}, &topology});
    const auto is_same = [](const MeetingFaces& p, const MeetingFaces& q) {
      return p.a == q.a && p.b == q.b && p.contact == q.contact;
    };
    CHECK(std::equal(plain.listed.begin(), plain.listed.end(), found.listed.begin(), found.listed.end(), is_same));
    CHECK(std::pair(plain.crossing, plain.touching) == std::pair(found.crossing, found.touching));
    return found;
  }
};

Contacts contacts_of(const SelfIntersections& found) {
  Contacts contacts;
  for (const MeetingFaces& pair : found.listed)
    contacts[{+pair.a, +pair.b}] = pair.contact;
  return contacts;
}

// All pairs of triangles, one by one.
Contacts contacts_one_by_one(const Subject& subject) {
  const auto triangle = [&](std::uint32_t f) {
    const auto point = [&](std::uint32_t h) { return &subject.mesh.points[+subject.mesh.corners[h]]; };
    return ContactTriangle{{point(3 * f), point(3 * f + 1), point(3 * f + 2)}, 0};
  };
  Contacts contacts;
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    for (std::uint32_t g = f + 1; g < subject.mesh.face_count(); ++g) {
      if (subject.geometry.is_degenerate(FaceId{f}) || subject.geometry.is_degenerate(FaceId{g})) continue;
      const Contact contact = contact_of(triangle(f), triangle(g));
      if (contact != Contact::none) contacts[{f, g}] = contact;
    }
  }
  return contacts;
}

// Triangles all around the first point, `turns` times, with a brim of uneven height; far ones hide nothing.
PolygonSoup fan_around(std::uint32_t count, int turns, double height, Random& random) {
  std::vector<Vec3> points{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}};
  const Vec3 u = random.direction(), w = random.direction();
  const Vec3 v{u.y * w.z - u.z * w.y, u.z * w.x - u.x * w.z, u.x * w.y - u.y * w.x};
  Faces faces;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * turns * (i + random.uniform(-0.3, 0.3)) / count, r = random.uniform(0.3, 1);
    const double x = r * std::cos(angle), y = r * std::sin(angle), z = height * random.uniform(-1, 1);
    points.push_back({points[0].x + x * u.x + y * v.x + z * w.x, points[0].y + x * u.y + y * v.y + z * w.y,
                      points[0].z + x * u.z + y * v.z + z * w.z});
    faces.push_back({0, 1 + i, 1 + (i + 1) % count});
  }
  return make_soup(points, faces);
}

// An axis-parallel rectangle between whole coordinates: what it has in common with another needs no geometry.
struct Rectangle {
  std::array<int, 3> low, high;  // equal on one axis

  [[nodiscard]] std::vector<Vec3> corners() const {
    const int flat = low[0] == high[0] ? 0 : low[1] == high[1] ? 1 : 2, u = (flat + 1) % 3, v = (flat + 2) % 3;
    std::vector<Vec3> points;
    for (const auto& [at_u, at_v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      std::array<int, 3> p = low;
      p[u] = at_u == 0 ? low[u] : high[u];
      p[v] = at_v == 0 ? low[v] : high[v];
      points.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
    }
    return points;
  }
  [[nodiscard]] bool has_corner(const std::array<int, 3>& p) const {
    for (int k = 0; k < 3; ++k)
      if (p[k] != low[k] && p[k] != high[k]) return false;
    return true;
  }
};

Contact contact_of(const Rectangle& a, const Rectangle& b) {
  std::array<int, 3> low, high;
  int dimension = 0;
  bool do_interiors_meet = true;
  for (int k = 0; k < 3; ++k) {
    low[k] = std::max(a.low[k], b.low[k]);
    high[k] = std::min(a.high[k], b.high[k]);
    if (low[k] > high[k]) return Contact::none;
    dimension += low[k] < high[k];
    if (low[k] < high[k]) continue;
    for (const Rectangle& r : {a, b})  // a point inside of an interval, or all of it
      do_interiors_meet = do_interiors_meet && (r.low[k] == r.high[k] || (r.low[k] < low[k] && low[k] < r.high[k]));
  }
  const bool is_shared = a.has_corner(low) && a.has_corner(high) && b.has_corner(low) && b.has_corner(high);
  if (dimension < 2 && is_shared) return Contact::none;
  return do_interiors_meet ? Contact::crossing : Contact::touching;
}

PolygonSoup soup_of(const std::vector<Rectangle>& rectangles) {
  std::vector<Vec3> points;
  Faces faces;
  for (const Rectangle& r : rectangles) {
    const auto first = static_cast<std::uint32_t>(points.size());
    const std::vector<Vec3> corners = r.corners();
    points.insert(points.end(), corners.begin(), corners.end());
    faces.push_back({first, first + 1, first + 2, first + 3});
  }
  return make_soup(points, faces);
}

}  // namespace

TEST_CASE("rectangles intersect as their intervals do, for any triangulation") {
  std::map<Contact, std::size_t> seen;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    std::vector<Rectangle> rectangles(12);
    for (Rectangle& r : rectangles) {
      const int flat = static_cast<int>(random.below(3));
      for (int k = 0; k < 3; ++k) {
        r.low[k] = static_cast<int>(random.below(4));
        r.high[k] = k == flat ? r.low[k] : r.low[k] + 1 + static_cast<int>(random.below(3));
      }
    }
    Contacts expected;
    for (std::uint32_t f = 0; f < rectangles.size(); ++f) {
      for (std::uint32_t g = f + 1; g < rectangles.size(); ++g) {
        const Contact contact = contact_of(rectangles[f], rectangles[g]);
        ++seen[contact];
        if (contact != Contact::none) expected[{f, g}] = contact;
      }
    }
    const SelfIntersections found = Subject(soup_of(rectangles)).found();
    CHECK(contacts_of(found) == expected);
    for (const MeetingFaces& pair : found.listed) {
      for (const FaceId f : {pair.a, pair.b}) {
        const Rectangle& r = rectangles[+f];
        const std::array<double, 3> p{pair.point.x, pair.point.y, pair.point.z};
        for (int k = 0; k < 3; ++k)
          CHECK((p[k] >= r.low[k] - 1e-12 && p[k] <= r.high[k] + 1e-12));
      }
    }
  }
  for (const Contact contact : {Contact::none, Contact::touching, Contact::crossing})
    CHECK(seen[contact] > 1000);
}

TEST_CASE("self-intersection: polygons, also concave ones, are tested by their interior") {
  // A C of seven squares around an empty middle, and needles through the middle, the arm, the inner rim.
  const std::vector<Vec3> c{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 2, 0}, {3, 2, 0}, {3, 3, 0}, {0, 3, 0}};
  const auto with_needle = [&](double x, double y) {
    std::vector<Vec3> points = c;
    points.insert(points.end(), {{x, y, -1}, {x + 0.1, y, -1}, {x, y, 1}});
    return Subject(make_soup(points, {{0, 1, 2, 3, 4, 5, 6, 7}, {8, 9, 10}})).found();
  };
  CHECK(with_needle(1.5, 1.5).listed.empty());
  CHECK(with_needle(2, 0.5).crossing == 1);
  CHECK(with_needle(0.5, 1.5).crossing == 1);
  CHECK(with_needle(1.5, 1).touching == 1);
  // A polygon that crosses itself is the fan from its first corner, and no pair with itself.
  const PolygonSoup bow = make_soup({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}, {0.2, 0.5, -1}, {0.3, 0.5, -1}, {0.2, 0.5, 1}},
                                    {{0, 1, 2, 3}, {4, 5, 6}});
  CHECK((contacts_of(Subject(bow).found()) == Contacts{{{0, 1}, Contact::crossing}}));
}

TEST_CASE("self-intersection: degenerate, invalid and non-finite faces are ignored") {
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 0}, {1, 1, 1}, {NAN, 1, 1}, {2, 1, -1}};
  const auto pairs = [&](const Faces& faces) { return Subject(make_soup(points, faces)).found().listed.size(); };
  CHECK(pairs({{0, 1, 2}, {3, 5, 7}}) == 1);
  CHECK(pairs({{0, 1, 2}, {3, 4, 5}}) == 0);
  CHECK(pairs({{0, 1, 2}, {3, 5, 3}}) == 0);
  CHECK(pairs({{0, 1, 2}, {3, 5, 6}}) == 0);
  CHECK(pairs({{0, 1, 2}, {3, 5, PolygonSoup::kInvalidVertex}}) == 0);
  CHECK(pairs({{0, 1, 2}, {3, 5}}) == 0);
  CHECK(pairs({{0, 1, 2}, {2, 0, 1}, {0, 2, 1}}) == 3);  // copies
  CHECK(pairs({}) == 0);
}

TEST_CASE("self-intersection: totals and listed pairs depend on neither threads nor cap") {
  PolygonSoup other = bumpy_sphere(24, 24);
  for (Vec3& p : other.points)
    p.x += 0.7;
  const Subject subject(joined(bumpy_sphere(24, 24), other));
  const SelfIntersections all = subject.found(kAllElements, 1);
  REQUIRE(all.listed.size() > 50);
  CHECK(contacts_of(all) == contacts_one_by_one(subject));
  CHECK(std::is_sorted(all.listed.begin(), all.listed.end(),
                       [](const auto& p, const auto& q) { return std::pair(p.a, p.b) < std::pair(q.a, q.b); }));
  for (const unsigned jobs : {1u, 2u, 7u}) {
    for (const std::size_t most : {std::size_t{0}, std::size_t{7}, kAllElements}) {
      const SelfIntersections found = subject.found(most, jobs);
      CHECK(found.crossing == all.crossing);
      CHECK(found.touching == all.touching);
      REQUIRE(found.listed.size() == std::min(most, all.listed.size()));
      for (std::size_t i = 0; i < found.listed.size(); ++i) {
        CHECK(found.listed[i].a == all.listed[i].a);
        CHECK(found.listed[i].b == all.listed[i].b);
        CHECK(found.listed[i].point == all.listed[i].point);
      }
    }
  }
}

TEST_CASE("self-intersection: very many faces around a vertex or an edge, in bounded time") {
  constexpr std::uint32_t kMany = 700;
  Random random(5);
  const auto turned = [](double angle, double radius, double z) {
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
  };
  std::vector<Vec3> points{{0, 0, 0}, {0, 0, 4}};
  SECTION("around a vertex, some through others") {
    Faces faces;
    for (std::uint32_t i = 0; i < kMany; ++i) {
      const double angle = 6.283185307179586 * i / kMany;
      points.push_back(turned(angle, 1, random.uniform(0.4, 0.6)));
      points.push_back(turned(angle + 0.012, 1, random.uniform(0.4, 0.6)));
      faces.push_back({0, 2 * i + 2, 2 * i + 3});
    }
    const Subject subject(make_soup(points, faces));
    const Contacts expected = contacts_one_by_one(subject);
    CHECK(expected.size() > 50);
    CHECK(contacts_of(subject.found()) == expected);
  }
  SECTION("around an edge, some folded onto others") {
    Faces faces;
    for (std::uint32_t i = 0; i < kMany; ++i) {
      const double x = random.below(40) - 20.0, y = random.below(40) - 20.0;
      points.push_back({x, y, static_cast<double>(random.below(5))});
      faces.push_back({i % 2, 1 - i % 2, i + 2});
    }
    const Subject subject(make_soup(points, faces));
    const Contacts expected = contacts_one_by_one(subject);
    CHECK(expected.size() > 100);
    CHECK(contacts_of(subject.found()) == expected);
  }
  SECTION("200,000 of them") {
    Faces fan, book;
    for (std::uint32_t i = 0; i < 200'000; ++i) {
      points.push_back(turned(6.283185307179586 * i / 200'000, 1, 1));
      fan.push_back({0, i + 2, i + 1 < 200'000 ? i + 3 : 2});
      book.push_back({0, 1, i + 2});
    }
    const std::clock_t start = std::clock();
    CHECK(Subject(make_soup(points, fan)).found().listed.empty());
    CHECK(Subject(make_soup(points, book)).found().listed.empty());
    // Seconds where it takes a fraction of one: only looking at each of 2 * 10^10 pairs fails this.
    CHECK(std::clock() - start < 30 * CLOCKS_PER_SEC);
  }
}

TEST_CASE("self-intersection: outliers and distant parts make the search neither slow nor wrong") {
  PolygonSoup soup = bumpy_sphere(100, 100);
  for (const double far : {1e9, 1e300}) {
    PolygonSoup with = soup;
    for (int part = 0; part < 3; ++part) {
      PolygonSoup crossed = joined(cube({0, 0, 0}, 1), cube({0.5, 0.25, 0.125}, 1));
      for (Vec3& p : crossed.points)
        p.x += far * part / 2;
      if (far < 1e20 || part == 0) with = joined(with, crossed);
    }
    with.points[0].z = far;
    const Subject subject(with);
    const std::clock_t start = std::clock();
    const SelfIntersections found = subject.found();
    CHECK(found.crossing + found.touching >= (far < 1e20 ? 27u : 9u));
    CHECK(std::clock() - start < 20 * CLOCKS_PER_SEC);
  }
}

TEST_CASE("faces around a vertex meet as pairs of them do, however often they turn around it") {
  Random random(11);
  std::size_t with_none = 0, with_some = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::uint32_t count = 3 + random.below(16);
    const int turns = 1 + static_cast<int>(random.below(3));
    const double heights[] = {0, 1e-17, 1e-9, 0.1, 1, 5};
    CAPTURE(round, count, turns);
    const Subject subject(fan_around(count, turns, heights[random.below(6)], random));
    const Contacts found = contacts_of(subject.found());
    CHECK(found == contacts_one_by_one(subject));
    ++(found.empty() ? with_none : with_some);
  }
  CHECK(with_none > 300);
  CHECK(with_some > 300);
}

TEST_CASE("a vertex is decided where its faces lie around it once, and not where they lie so twice or fold") {
  const auto simple_at_first = [](const PolygonSoup& soup) {
    const Subject subject(soup);
    return find_simple_stars(subject.mesh, subject.topology, 1).is_simple.front() != 0;
  };
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    CHECK(simple_at_first(fan_around(8, 1, 0.05, random)));
    CHECK(!simple_at_first(fan_around(12, 2, 0.05, random)));
  }
}
