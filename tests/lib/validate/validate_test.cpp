// SPDX-License-Identifier: Apache-2.0
// A little over 400 lines: rules on small meshes by hand, solids within solids, elements and caps, then a recount at random.
#include "validate/validate.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>
#include <random>

#include "catch.hpp"
#include "recount.hpp"
#include "soups.hpp"

namespace Catch {
template <>
struct StringMaker<std::map<std::string, std::uint64_t>> {
  static std::string convert(const std::map<std::string, std::uint64_t>& totals) {
    std::string out = "{";
    for (const auto& [rule, total] : totals)
      out += " " + rule + "=" + std::to_string(total);
    return out + " }";
  }
};
}  // namespace Catch

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::Faces;
using fdcg::test::joined;
using fdcg::test::make_soup;
using fdcg::test::reversed;

namespace {

using Totals = std::map<std::string, std::uint64_t>;

Totals totals(const Report& report) {
  Totals result;
  for (const Issue& issue : report.issues)
    result[issue.rule] = issue.total;
  return result;
}
Totals totals(const PolygonSoup& soup, const ValidateOptions& options = {}) {
  return totals(validate(soup, options));
}

const Issue& issue(const Report& report, const std::string& rule) {
  for (const Issue& i : report.issues)
    if (i.rule == rule) return i;
  FAIL("no issue " << rule);
  return report.issues[0];
}

const std::vector<Vec3> kGrid{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PolygonSoup tetrahedron(Vec3 at = {}) {
  return make_soup({at, {at.x + 1, at.y, at.z}, {at.x, at.y + 1, at.z}, {at.x, at.y, at.z + 1}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
}

// A band of quads, closed with a half turn if their number of turns is odd.
PolygonSoup band(std::uint32_t quads, bool moebius) {
  std::vector<Vec3> points;
  Faces faces;
  for (std::uint32_t i = 0; i < quads; ++i) {
    const double a = 6.283185307179586 * i / quads, b = moebius ? a / 2 : 0;
    for (const double s : {-0.3, 0.3}) {
      points.push_back(
          {(2 + s * std::cos(b)) * std::cos(a), (2 + s * std::cos(b)) * std::sin(a), s * std::sin(b) + (moebius ? 0 : s)});
    }
  }
  for (std::uint32_t i = 0; i < quads; ++i) {
    const bool twist = moebius && i + 1 == quads;
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % quads);
    const std::uint32_t c = twist ? b + 1 : b, d = twist ? b : b + 1;
    faces.push_back({a, c, a + 1});
    faces.push_back({a + 1, c, d});
  }
  return make_soup(points, faces);
}

}  // namespace

TEST_CASE("clean meshes pass without any finding") {
  CHECK(totals(cube()).empty());
  CHECK(totals(tetrahedron()).empty());
  CHECK(totals(bumpy_sphere(20, 30)).empty());
  const Report report = validate(cube());
  CHECK(report.passes());
  CHECK(report.passes(Severity::note));
  CHECK(report.vertices == 8);
  CHECK(report.faces == 6);
  CHECK(report.components == 1);
  CHECK(report.checks.size() == 19);
  for (const std::string& name : report.checks)
    CHECK(find_rule(name) != nullptr);
}

TEST_CASE("each rule has a mesh that raises it, located") {
  SECTION("empty-mesh") {
    CHECK(totals(PolygonSoup{}) == Totals{{"empty-mesh", 1}});
    CHECK(totals(make_soup(kGrid, {})) == Totals{{"empty-mesh", 1}, {"isolated-vertex", 8}});
    CHECK_FALSE(validate(PolygonSoup{}).passes());
  }
  SECTION("non-finite-coordinate") {
    PolygonSoup soup = bumpy_sphere(10, 10);
    soup.points[7].y = kNan;
    soup.points[9].z = -std::numeric_limits<double>::infinity();
    const Report report = validate(soup);
    CHECK(totals(report) == Totals{{"non-finite-coordinate", 2}});
    CHECK(issue(report, "non-finite-coordinate").elements[1].vertices == std::vector<std::uint32_t>{9});
  }
  SECTION("index-out-of-range") {
    PolygonSoup soup = cube();
    soup.corners[9] = PolygonSoup::kInvalidVertex;
    const Report report = validate(soup);
    CHECK(totals(report) == Totals{{"index-out-of-range", 1}, {"boundary-edge", 4}});
    CHECK(issue(report, "index-out-of-range").elements[0].faces == std::vector<std::uint32_t>{2});
  }
  SECTION("degenerate-face, by a repeated corner and by collinear corners") {
    const PolygonSoup soup =
        make_soup({{0, 0, 0}, {0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {1, 0, 0}}, {{0, 1, 1}, {0, 1, 2}, {0, 2, 3}});
    const Report report = validate(soup);
    // 0.3 is not three times 0.1 in binary, but the three coordinates of each point agree: exactly collinear.
    CHECK(issue(report, "degenerate-face").total == 2);
    CHECK(issue(report, "degenerate-face").elements[1].faces == std::vector<std::uint32_t>{1});
  }
  SECTION("duplicate-face") {
    const PolygonSoup soup = make_soup(kGrid, {{0, 1, 3}, {3, 0, 1}, {1, 0, 3}, {2, 3, 6}});
    const Report report = validate(soup);
    CHECK(issue(report, "duplicate-face").total == 2);
    CHECK(issue(report, "duplicate-face").elements[1].faces == std::vector<std::uint32_t>{2, 0});
  }
  SECTION("non-manifold-edge: a fan of three") {
    const PolygonSoup soup = make_soup(kGrid, {{0, 1, 2}, {1, 0, 4}, {0, 1, 7}});
    const Report report = validate(soup);
    CHECK(totals(report) == Totals{{"non-manifold-edge", 1}, {"boundary-edge", 6}, {"isolated-vertex", 3}});
    const Element& element = issue(report, "non-manifold-edge").elements[0];
    CHECK(element.edges == std::vector<std::array<std::uint32_t, 2>>{{0, 1}});
    CHECK(element.faces == std::vector<std::uint32_t>{0, 1, 2});
    CHECK(element.point == Vec3{0.5, 0, 0});
  }
  SECTION("non-manifold-vertex: an hourglass of two tetrahedra") {
    PolygonSoup soup = joined(tetrahedron(), reversed(tetrahedron()));
    for (std::size_t i = 4; i < 8; ++i)
      soup.points[i] = {-soup.points[i].x, -soup.points[i].y, -soup.points[i].z};
    const Report report = validate(soup);
    CHECK(totals(report) == Totals{{"non-manifold-vertex", 1}, {"duplicate-vertex", 1}});
    CHECK(issue(report, "non-manifold-vertex").elements[0].vertices == std::vector<std::uint32_t>{0});
    CHECK(issue(report, "duplicate-vertex").elements[0].vertices == std::vector<std::uint32_t>{4});
    CHECK(report.components == 1);
    CHECK(totals(soup, {{Weld::Kind::none, 0}, {}, 100, {}}) == Totals{{"self-intersection", 9}});  // three faces at three
  }
  SECTION("winding-inconsistent: one face of a sphere flipped") {
    PolygonSoup soup = bumpy_sphere(10, 10);
    std::swap(soup.corners[3 * 40], soup.corners[3 * 40 + 1]);
    const Report report = validate(soup);
    CHECK(totals(report) == Totals{{"winding-inconsistent", 3}});
    CHECK(issue(report, "winding-inconsistent").elements[0].faces.size() == 2);
  }
  SECTION("folded-edge: a triangle and its back, a triangle folded over its neighbour") {
    CHECK(totals(make_soup(kGrid, {{0, 1, 2}, {0, 2, 1}}))["folded-edge"] == 3);
    const PolygonSoup over = make_soup({{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 0, 3}});
    CHECK(totals(over) == Totals{{"folded-edge", 1}, {"boundary-edge", 4}, {"self-intersection", 1}});
  }
  SECTION("boundary-edge") {
    PolygonSoup soup = cube();
    soup.face_first.pop_back();
    const Report report = validate(soup);
    CHECK(totals(report) == Totals{{"boundary-edge", 4}});
    CHECK(report.passes());
    CHECK_FALSE(report.passes(Severity::warning));
  }
  SECTION("non-planar-face") {
    PolygonSoup soup = cube();
    soup.points[7].x += 1e-9;
    CHECK(totals(soup) == Totals{{"non-planar-face", 1}});  // the other two faces there are moved along themselves
    soup.absolute_quantum = 1e-8;                           // a text of eight digits cannot say it better
    CHECK(totals(soup).empty());
  }
}

TEST_CASE("a polygon rotated in floating point counts as planar, in double and in float") {
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 200; ++round) {
    PolygonSoup soup = cube({10, -3, 2}, 1);
    double q[4];
    for (double& c : q)
      c = normal(rng);
    const double s = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (Vec3& p : soup.points) {  // by a unit quaternion
      const Vec3 o = p;
      p.x = (1 - s * (q[2] * q[2] + q[3] * q[3])) * o.x + s * (q[1] * q[2] - q[0] * q[3]) * o.y +
            s * (q[1] * q[3] + q[0] * q[2]) * o.z;
      p.y = s * (q[1] * q[2] + q[0] * q[3]) * o.x + (1 - s * (q[1] * q[1] + q[3] * q[3])) * o.y +
            s * (q[2] * q[3] - q[0] * q[1]) * o.z;
      p.z = s * (q[1] * q[3] - q[0] * q[2]) * o.x + s * (q[2] * q[3] + q[0] * q[1]) * o.y +
            (1 - s * (q[1] * q[1] + q[2] * q[2])) * o.z;
      if (round % 2 == 1) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    soup.relative_quantum = round % 2 == 1 ? 0x1p-24 : 0x1p-53;
    CHECK(totals(soup).empty());
  }
}

TEST_CASE("a Moebius strip gives one finding, however it is wound; a plain band has boundary edges only") {
  for (const std::uint32_t quads : {3U, 4U, 5U, 50U}) {
    CAPTURE(quads);
    Totals strip = totals(band(quads, true));
    CHECK(strip["not-orientable"] == 1);
    CHECK(strip["winding-inconsistent"] == 1);
    CHECK(strip["boundary-edge"] == 2 * quads);
    CHECK(totals(band(quads, false)) == Totals{{"boundary-edge", 2 * quads}});
    PolygonSoup flipped = band(quads, true);
    std::swap(flipped.corners[0], flipped.corners[1]);
    CHECK(totals(flipped)["not-orientable"] == 1);
    const Report two = validate(joined(band(quads, true), make_soup({{9, 9, 9}, {8, 9, 9}, {9, 8, 9}}, {{0, 1, 2}})));
    CHECK(issue(two, "not-orientable").total == 1);
    CHECK(two.components == 2);
  }
}

TEST_CASE("a cavity in a solid is not inside out, whatever other parts there are") {
  const PolygonSoup hollow = joined(cube({}, 4), reversed(cube({}, 2)));
  CHECK(totals(hollow).empty());
  CHECK(totals(reversed(hollow)) == Totals{{"inside-out", 1}});  // the shell; the core is a solid in it
  CHECK(totals(joined(hollow, cube({}, 1))).empty());            // a stone in the cavity
  CHECK(totals(joined(hollow, reversed(cube({}, 1)))) == Totals{{"inside-out", 1}});
  CHECK(totals(joined(cube({}, 2), cube({}, 4))).empty());  // a solid in a solid encloses no negative volume
  // Rays that start on the level of vertices, edges and faces of the others.
  CHECK(totals(joined(joined(cube({}, 4), reversed(cube({}, 2))), cube({10, 0, 0}, 4))).empty());
  CHECK(totals(joined(joined(cube({}, 4), reversed(cube({10, 1, 1}, 2))), cube({20, 0, 0}, 4))) == Totals{{"inside-out", 1}});
}

TEST_CASE("of two separate cubes the one inside out is found, and may be allowed") {
  const PolygonSoup soup = joined(cube({-3, 0, 0}), reversed(cube({3, 0, 0})));
  const Report report = validate(soup);
  CHECK(totals(report) == Totals{{"inside-out", 1}});
  CHECK(issue(report, "inside-out").elements[0].faces == std::vector<std::uint32_t>{6});
  CHECK_FALSE(report.passes());
  const Report allowed = validate(soup, {{}, {"inside-out", "non-manifold-edge"}, 100, {}});
  CHECK(allowed.passes());
  CHECK(allowed.allowed == std::set<std::string>{"inside-out"});  // the other cannot be
  CHECK(totals(reversed(cube())) == Totals{{"inside-out", 1}});
  CHECK(totals(reversed(cube({1e6, 1e6, 1e6}, 1e-3))) == Totals{{"inside-out", 1}});
}

TEST_CASE("nesting of parts that touch in a vertex is found from a vertex that does not touch") {
  // The small cube shares the corner (2, 2, 2) with the large one that holds it.
  const PolygonSoup inner = joined(cube({}, 4), reversed(cube({1, 1, 1}, 2)));
  // Each of three walls of the large one has one of the small one's faces on it and the edges of four others.
  CHECK(totals(inner) == Totals{{"non-manifold-vertex", 1}, {"duplicate-vertex", 1}, {"self-intersection", 15}});
  const PolygonSoup outer = joined(cube({}, 4), reversed(cube({3, 3, 3}, 2)));
  CHECK(totals(outer) == Totals{{"non-manifold-vertex", 1}, {"duplicate-vertex", 1}, {"inside-out", 1}});
}

TEST_CASE("nested shells alternate between outward and inward") {
  PolygonSoup soup = cube({}, 1);
  for (int i = 2; i <= 41; ++i)
    soup = joined(soup, reversed(cube({}, i)));
  CHECK(totals(soup)["inside-out"] == 20);  // of the 40 outer ones every second lies at an even depth, the outermost too
}

TEST_CASE("a flat closed pocket has no volume and is not inside out") {
  // A doubly covered square far from the origin and tilted, so that the sum does not vanish in floating point.
  PolygonSoup soup = make_soup({{0.1, 0.2, 0.3}, {1.3, 0.7, 0.9}, {2.5, 1.2, 1.5}, {0.7, 5.1, 0.4}},
                               {{0, 1, 3}, {1, 2, 3}, {1, 0, 3}, {2, 1, 3}});
  Totals found = totals(soup);
  CHECK(found.count("inside-out") == 0);
}

TEST_CASE("totals are exact when the listed elements are capped") {
  PolygonSoup soup = bumpy_sphere(40, 40);
  const std::uint64_t faces = soup.face_count();
  const PolygonSoup loose = [&] {
    PolygonSoup s = soup;
    s.points.clear();
    for (std::uint32_t h = 0; h < soup.corners.size(); ++h) {
      s.points.push_back(soup.points[soup.corners[h]]);
      s.corners[h] = h;
    }
    return s;
  }();
  ValidateOptions unwelded{{Weld::Kind::none, 0}, {}, 7, {}};
  // Not welded, each face meets those around it.
  CHECK(issue(validate(loose, unwelded), "self-intersection").elements.size() == 7);
  unwelded.severities["self-intersection"] = std::nullopt;
  const Report report = validate(loose, unwelded);
  CHECK(totals(report) == Totals{{"boundary-edge", 3 * faces}});
  CHECK(report.issues[0].elements.size() == 7);
  CHECK(report.components == faces);
  CHECK(report.vertices == 3 * faces);
  CHECK(totals(loose) == Totals{{"duplicate-vertex", 3 * faces - soup.points.size()}});
}

TEST_CASE("elements carry the lines of a text file") {
  PolygonSoup soup = make_soup(kGrid, {{0, 1, 1}, {0, 1, 2}});
  soup.face_line = {12, 13};
  for (std::uint32_t i = 0; i < 8; ++i)
    soup.point_line.push_back(i + 3);
  const Report report = validate(soup);
  CHECK(issue(report, "degenerate-face").elements[0].line == 12U);
  CHECK(issue(report, "boundary-edge").elements[0].line == 13U);
  CHECK(issue(report, "isolated-vertex").elements[0].line == 6U);
}

TEST_CASE("all totals agree with a recount by definition on random small meshes with seeded defects") {
  std::mt19937 rng(424242);
  const auto below = [&](std::size_t n) { return static_cast<std::uint32_t>(rng() % n); };
  std::map<std::string, int> raised;
  for (int round = 0; round < 3000; ++round) {
    CAPTURE(round);
    PolygonSoup soup;
    if (round % 3 == 0) {  // polygons thrown together on a small lattice
      std::vector<Vec3> points(4 + below(8));
      for (Vec3& p : points)
        p = {double(below(3)), double(below(3)), double(below(2))};
      Faces faces(1 + below(8));
      for (auto& face : faces) {
        face.resize(3 + below(2));
        for (auto& corner : face)
          corner = below(points.size());
      }
      soup = make_soup(points, faces);
    } else {  // solids with defects
      soup = round % 3 == 1 ? cube() : tetrahedron();
      if (below(2) == 0)
        soup = joined(soup, below(2) == 0 ? cube({double(2 * below(3)), 8, 0}) : tetrahedron({double(below(2)), 0, 8}));
      for (std::uint32_t defects = below(5); defects > 0; --defects) {
        const std::uint32_t f = below(soup.face_count());
        const auto begin = soup.corners.begin() + soup.face_first[f], end = soup.corners.begin() + soup.face_first[f + 1];
        switch (below(7)) {
          case 0:
            std::reverse(begin, end);
            break;  // flip
          case 1:
            *begin = PolygonSoup::kInvalidVertex;
            break;  // delete
          case 2:   // duplicate
            for (std::uint32_t h = soup.face_first[f]; h < soup.face_first[f + 1]; ++h)
              soup.corners.push_back(soup.corners[h]);
            soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            break;
          case 3:
            soup.points[below(soup.points.size())] = soup.points[below(soup.points.size())];
            break;  // pinch
          case 4:
            soup.points[below(soup.points.size())].x = kNan;
            break;
          case 5:
            *begin = below(soup.points.size());
            break;  // rewire
          default:
            soup.points[below(soup.points.size())].z += 2;
            break;  // bend
        }
      }
    }
    const bool weld = below(4) != 0;
    ValidateOptions options{{weld ? Weld::Kind::exact : Weld::Kind::none, 0}, {}, 3, {}};
    options.severities["self-intersection"] = std::nullopt;  // has a recount of its own: self_intersection_test
    const Report report = validate(soup, options);
    const fdcg::test::Recount recount(soup, weld);
    CHECK(totals(report) == recount.totals);
    CHECK(report.components == recount.components);
    CHECK(report.vertices == recount.vertices);
    for (const auto& [rule, total] : recount.totals)
      ++raised[rule];
  }
  for (const char* rule :
       {"non-finite-coordinate", "index-out-of-range", "degenerate-face", "duplicate-face", "non-manifold-edge",
        "non-manifold-vertex", "winding-inconsistent", "inside-out", "folded-edge", "boundary-edge", "non-planar-face",
        "isolated-vertex", "duplicate-vertex", "not-orientable", "self-crossing-face", "t-junction"}) {
    INFO(rule);
    CHECK(raised[rule] > 5);
  }
}

TEST_CASE("a polygon of 65,000 corners and a vertex of 100,000 faces are checked in near linear time") {
  constexpr std::uint32_t kSides = 65000;
  std::vector<Vec3> points;
  std::vector<std::uint32_t> floor, roof;
  Faces faces;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double a = 6.283185307179586 * i / kSides;
    points.push_back({std::cos(a), std::sin(a), 0});
    points.push_back({std::cos(a), std::sin(a), 1});
    floor.insert(floor.begin(), 2 * i);
    roof.push_back(2 * i + 1);
    const std::uint32_t n = 2 * ((i + 1) % kSides);
    faces.push_back({2 * i, n, n + 1, 2 * i + 1});
  }
  faces.push_back(floor);
  faces.push_back(roof);
  const std::clock_t start = std::clock();
  CHECK(totals(make_soup(points, faces)) == Totals{{"sliver-face", kSides}});  // the walls
  CHECK(totals(make_soup(points, {roof, std::vector<std::uint32_t>(roof.rbegin(), roof.rend())}))["folded-edge"] == kSides);
  CHECK(totals(bumpy_sphere(3, 100000, 0)) == Totals{{"sliver-face", 400000}});
  // Seconds where it takes a fraction of one: only a quadratic search fails this.
  CHECK(std::clock() - start < 20 * CLOCKS_PER_SEC);
}
